// One interface to all lights of a scene: emissive triangles, which are one light for each emissive
// material, and those of Scene::lights. Power is in W, linear sRGB.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/cdf.h"
#include "core/random.h"
#include "core/sampling.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/emission_grid.h"

namespace bnvpl {

// A light sample: a direction from a point, and the radiance that arrives if nothing occludes it.
struct LightSample {
  Vec3 wi;                // unit, towards the light
  Vec3 radianceOverPdf;   // radiance / pdf; with pdf 0, the irradiance on a facing surface
  float pdf = 0.0f;       // density of wi given the light, 1/sr; 0 for lights that no ray can hit
  bool infinite = false;  // whether the light is at infinity
  Vec3 target;            // else the end of the shadow ray, offset off the emitter
};

struct PhotonStart {
  Vec3 origin;     // offset off the emitter
  Vec3 direction;  // unit
  Vec3 flux;       // W, if this were the only photon of its light
};

// A point of the unit hypercube from which a light samples a photon: 0 and 1 are the place on an
// area light, or the direction of another; 2 and 3 are the direction from an area light, or the
// place on the scene's box of a light at infinity.
using PrimarySample = std::array<float, 4>;

class LightSet {
 public:
  // Throws InputError if the power of a light overflows floats.
  explicit LightSet(const Accelerator& accel);

  size_t size() const { return lights_.size(); }
  Vec3 power(size_t light) const { return lights_[light].power; }
  Vec3 totalPower() const;
  std::string name(size_t light) const;  // for messages
  // Index into Scene::lightGroups.
  uint32_t group(size_t light) const {
    const Light& l = lights_[light];
    return l.area ? scene_.materials[l.material].lightGroup : l.spec.group;
  }

  // The same lights, but pick() returns only those that no ray can hit. BSDF rays find the others.
  LightSet onlyUnhittable() const;

  // Picks a light in proportion to power.
  size_t pick(float u, float& probability) const;
  float pickProbability(size_t light) const { return lights_[light].pickProbability; }
  // Whether a ray can hit the light by chance, which holds unless it is a point or a single
  // direction.
  bool hittable(size_t light) const {
    return lights_[light].area || std::ranges::count(hittableAtInfinity_, light) > 0;
  }

  // Returns false if no light can arrive at `at` from the sample: it is behind the emitter, outside
  // the cone, or black.
  bool sampleDirect(size_t light, Vec3 at, float u, float v, LightSample& out) const;

  // Radiance that an emissive surface emits towards wo. `light` is set to its index, or kNone.
  Vec3 emitted(const SurfacePoint& hit, size_t& light) const;
  // Density, 1/sr, with which sampleDirect() samples this hit from `from`.
  float pdfDirect(size_t light, const SurfacePoint& hit, Vec3 from) const;

  // The inverse of sampleDirect(): the point of the unit square that it maps to a hit on an
  // emissive surface, or to the direction towards a light at infinity.
  Point2 invertSample(size_t light, const SurfacePoint& hit) const;
  Point2 invertSample(size_t light, Vec3 direction) const;

  // How the unit square of a light may be divided into strata.
  struct Extent {
    bool divisible = false;  // whether parts of the light can be occluded separately
    bool local = false;      // whether the light has a position
    Vec3 centre;             // its position, if local
    size_t facets = 1;       // triangles, side by side along u in proportion to power
  };
  Extent extent(size_t light) const;

  // Lights at infinity that a ray can hit: calls fn(light, radiance, pdf) for each.
  template <typename Fn>
  void forEachAtInfinity(Vec3 direction, const Fn& fn) const {
    for (const uint32_t i : hittableAtInfinity_) {
      float pdf = 0.0f;
      const Vec3 L = radianceAtInfinity(i, direction, pdf);
      if (!isBlack(L)) fn(size_t{i}, L, pdf);
    }
  }

  PhotonStart emit(size_t light, const PrimarySample& at) const;
  PhotonStart emit(size_t light, Rng& rng) const { return emit(light, primarySample(light, rng)); }
  // A point by power. Dimensions on which the light's photons do not depend are 0.
  PrimarySample primarySample(size_t light, Rng& rng) const;
  // The dimensions of PrimarySample on which a photon depends so that a density over them can be
  // looked up again by invertEmission().
  std::span<const uint8_t> primaryDimensions(size_t light) const;
  // The inverse of emit() for a photon that reaches `from` straight from the light, in the
  // direction `towards` the light. `place`: invertSample() of the hit or the direction.
  PrimarySample invertEmission(size_t light, Point2 place, Vec3 towards, Vec3 from) const;
  // Whether photons reach `from` from the direction `towards` the light if nothing is in between.
  // Those from infinity miss surfaces outside Scene::bounds.
  bool photonsReach(size_t light, Vec3 towards, Vec3 from) const;
  // Density of one photon of emit(), 1/unit^2: per area of the emitter; for a light at infinity, pi
  // times the density per projected area and solid angle, to match the 1/pi of cosine emission. 0
  // if no ray can hit the light. `towards` is the direction towards a light at infinity.
  float photonDensity(size_t light, Vec3 towards) const;

  // Whether any light has power. A sun parallel to a flat scene, or an emitter too weak for floats,
  // has none, although Scene::hasLight() holds for it.
  bool hasPower() const { return mean(totalPower()) > 0.0f; }
  // Throws InputError, naming the scene, if none has.
  void requirePower() const;
  // Throws InputError if squares of a light's irradiance overflow floats; gathering VPLs needs
  // them.
  void requireSquares() const;

 private:
  struct Light {
    LightSpec spec;     // a light of Scene::lights, unless `area`
    bool area = false;  // whether it is an area light of the following triangles
    uint32_t material = kNone;
    std::vector<uint32_t> triangles;
    // Running sums over the triangles by area, or by emission where textured; or over the texels of
    // each row of an environment image.
    std::vector<float> cdf;
    std::vector<EmissionGrid> grids;        // one for each textured triangle
    std::vector<double> rowCdf;             // running sums over the rows of the image
    std::vector<uint32_t> guide, rowGuide;  // guides of each row of `cdf`, and of rowCdf
    std::span<const uint32_t> guideOfRow(size_t row) const {
      return std::span(guide).subspan(row * kGuideSteps, kGuideSteps);
    }
    std::span<const float> cdfOfRow(size_t row, size_t width) const {
      return std::span(cdf).subspan(row * width, width);
    }
    float areaTotal = 0.0f;
    bool twoSided = false;
    Vec3 power;
    float pickProbability = 0.0f;
  };
  void addAreaLights();
  void addSceneLights();
  void setPickProbabilities(std::vector<double> weights);
  Vec3 radianceAtInfinity(size_t light, Vec3 direction, float& pdf) const;
  float texelPdf(const Light& light, size_t x, uint32_t y) const;
  Vec3 sampleDirection(const Light& light, float u, float v, Vec3& radiance, float& pdf) const;
  bool sampleArea(const Light& light, Vec3 at, float u, float v, LightSample& out) const;
  PhotonStart emitFromInfinity(const Light& light, const PrimarySample& at) const;
  struct EmitterPoint {
    Vec3 position, normal, emission;
    float density;  // relative to uniform sampling of the light's area
  };
  EmitterPoint samplePointOn(const Light& light, float u, float v) const;
  Vec3 emissionOn(const Material& m, uint32_t triangle, const Barycentric& at) const;
  Vec3 spreadTexture(Light& light, std::vector<double>& areas) const;
  float densityOver(const Light& light, size_t i, float ofGrid) const;
  struct Hit {
    size_t triangle;  // index into Light::triangles
    Barycentric at;
  };
  Hit hitOf(const Light& light, const SurfacePoint& hit) const;
  // Flux of an area light with uniform emission.
  static Vec3 fluxOf(const Light& light, Vec3 emission) {
    return emission * (kPi * light.areaTotal * (light.twoSided ? 2.0f : 1.0f));
  }

  const Accelerator& accel_;
  const Scene& scene_;
  std::vector<Light> lights_;
  std::vector<uint32_t> lightOfMaterial_;
  std::vector<uint32_t> hittableAtInfinity_;
  std::vector<float> pickCdf_;
};

}  // namespace bnvpl
