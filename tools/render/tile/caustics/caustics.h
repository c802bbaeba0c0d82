// Caustic photons: light that reaches directly visible surfaces over mirrors, glass and
// near-specular lobes. Of thousands of rays from such a surface one hits a small lamp on this way
// and makes a firefly, while every photon of the lamp may reach the surface.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "tools/render/film/integrator.h"
#include "tools/render/pixel_filter.h"
#include "tools/render/sample.h"
#include "tools/render/splat/splat.h"
#include "transport/direct_light/direct_light.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/photons/emission_guide.h"

namespace bnvpl {

// Rays for indirect light from what the camera sees.
struct CompetingRays {
  float ofPixel = 0.0f;          // their number
  float roughImportance = 1.0f;  // IndirectRays::roughImportance()
  // Light sampling of their specular vertices; null: by power.
  const SpatialLightSampler* spatialLights = nullptr;
};

// Photons pass at least one specular vertex and nothing else, and are connected with the camera at
// the first rough one. They share the light of lamps and sky with near-field rays by MIS; lights
// that no ray can hit are theirs alone.
//
// Photons start where pilot photons found ways into view (EmissionGuide). A further pilot measures
// the noise of each emitter's photons (emitterOf: a light, or a region of a sky). With the splats
// r_k of an emitter, (sum r_k)^2 / sum r_k^2 is the number of equal splats that would be as noisy.
// An emitter with fewer than kMinPilotPhotons of them is left to near-field rays: for example a
// lamp behind a door. The photons of the image are independent of the pilots', so that it stays
// unbiased.
//
// No path from the camera can end at a light that no ray can hit if a perfect mirror or glass lies
// before it. With `bounces` > 0 photons carry all of that light to directly visible surfaces: they
// go on from their first rough vertex, and each later one is connected with the camera as well.
// Immutable and thread-safe.
class Caustics {
 public:
  // `photons`: > 0; the lights have power. `rays` find the same light. `bounces`: rough vertices
  // after the first. `groups`: light groups to tell apart. Borrows accel, lights and those of rays.
  Caustics(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
           uint64_t photons, const CompetingRays& rays, unsigned bounces, uint64_t seed,
           uint32_t groups, const ProgressFn& progress);

  const PhotonLight& at(uint32_t x, uint32_t y) const { return light_[size_t{y} * width_ + x]; }
  // Parameters of MIS with rays that leave a point that is directly visible from `origin`, the
  // origin of the camera ray.
  PhotonMis photonMis(const SurfacePoint& point, Vec3 origin) const;
  CausticStats stats() const { return {emitters_, emitters_ - photonEmitters_.size(), useful_}; }

 private:
  static constexpr double kMinPilotPhotons = 4.0;
  static constexpr uint64_t kPhotonsPerPilotPhoton = 8;
  static constexpr uint64_t kPhotonsPerLearningPhoton = 16, kMaxFirstLearningPhotons = 1 << 20;
  // Limits if few have reached the film.
  static constexpr uint64_t kPhotonsPerFurtherPhoton = 8, kMaxLearningPhotons = 1 << 18;

  void learnGuide(uint64_t key, const ProgressFn& progress);
  void chooseEmitters(uint64_t key, const ProgressFn& progress);
  void add(const Splat& splat);
  PhotonMis misAt(float samplesPerArea) const;
  Vec3 lensPoint(Rng& rng) const;
  static constexpr uint64_t kNoEmitter = UINT64_MAX;
  // Follows one photon. Returns its emitter, or kNoEmitter if no ray can hit that.
  uint64_t follow(uint64_t key, uint64_t index, uint64_t count, Splats& out) const;
  // A photon that starts. `flux` is that of the one photon of many.
  struct Photon {
    EmissionSample emission;
    float guided;  // density of its emission, relative to emission by power
    PhotonStart start;
    Vec3 flux;
    bool hittable;  // whether rays can hit the light
    Vec3 lens;      // the point of the lens with which its vertices are connected
  };
  // The path that rays from the camera may take along the vertices of this photon, with the
  // probabilities that MIS needs (PhotonMis). The photon's last vertex is its first.
  struct CompetingPath {
    float specularBefore = 1.0f;       // probability of specular lobes at all vertices but the last
    float specularAtLast = 1.0f;       // that at the last, where the path begins there
    float specularAtLastLater = 1.0f;  // that at the last, where the path comes from another
    float shadowRays = 0.0f;  // ratio to BSDF rays at the photon's first vertex
    float probability() const { return specularBefore * specularAtLast; }
  };
  // Adds a specular vertex from which the photon goes on in the direction wi.
  void addVertex(const Bsdf& vertex, Vec3 wi, bool countsShadowRays, const Photon& photon,
                 CompetingPath& rays) const;
  float shadowRayRatio(const Bsdf& vertex, const Photon& photon) const;
  // Follows a photon through specular vertices.
  void trace(const Photon& photon, Rng& rng, Splats& out) const;
  // Follows the photon from a rough vertex, by its rough lobes.
  void followBounces(const Bsdf& bsdf, Vec3 flux, const Photon& photon, Rng& rng,
                     Splats& out) const;
  void connect(const SurfacePoint& vertex, Vec3 flux, const Photon& photon,
               const CompetingPath& rays, Splats& out) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  PixelFilter filter_;
  uint64_t photons_, key_;
  CompetingRays rays_;
  unsigned bounces_;
  uint32_t width_;
  std::vector<uint64_t> photonEmitters_;  // emitters with enough photons, ascending
  bool chosen_ = false;          // whether the pilot is done; until then all emitters send photons
  size_t emitters_ = 0;
  std::vector<PhotonLight> light_;
  std::vector<Vec3> groupLight_;  // by light group, pixel after pixel
  EmissionGuide guide_;
  UsefulPhotons useful_;
};

}  // namespace bnvpl
