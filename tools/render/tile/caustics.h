// Light over mirrors, glass and sharp lobes on what the camera sees directly: rays from there meet
// a small lamp by that way once in thousands of times, and shine in the image as a white speck.
// Photons find it always.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "tools/render/integrator/integrator.h"
#include "tools/render/integrator/splats.h"
#include "transport/direct_light.h"

namespace bnvpl {

// Photons that go over specular vertices alone, at least one, and are connected with the camera
// where they come to a rough one. They share the light of lamps and sky with the near-field rays by
// MIS, and bring all of what no ray can hit.
//
// A pilot of an eighth as many photons tells lamp by lamp (lampOf: a light, or a region of a sky)
// the noise of what photons bring: with the splats r_k of a lamp, (sum r_k)^2 / sum r_k^2 is the
// number of equal photons that would be as noisy. A lamp that does not have kMinPilotPhotons of
// them is left to the near-field rays: the sun over a wide ground, of which hardly a photon comes
// in through a window. The photons that count are others than the pilot's, so the mean stays right.
//
// No path from the camera can end at a light that no ray can hit, where a perfect mirror or glass
// lies before it. With `bounces` > 0 photons bring all of that light to what the camera sees
// directly: they go on from their first rough vertex, and each later one is connected as well.
// Thread-safe and immutable once made.
class Caustics {
 public:
  // So many photons, > 0, from lights with power, and rays from each pixel that look for the same
  // light. `bounces`: rough vertices after the first one. Borrows rays and lights.
  Caustics(const RayScene& rays, const LightSet& lights, uint64_t photons, float raysOfPixel,
           unsigned bounces, uint64_t seed, const ProgressFn& progress);

  const PhotonLight& at(uint32_t x, uint32_t y) const { return light_[size_t{y} * width_ + x]; }
  // How rays share with them that leave a point which the camera sees directly.
  SharedWithPhotons shared(const SurfacePoint& seen) const;
  // That rays can hit and photons were sent from, and those that are left to rays.
  size_t lamps() const { return lamps_; }
  size_t sparseLamps() const { return lamps_ - dense_.size(); }

 private:
  static constexpr double kMinPilotPhotons = 4.0;
  static constexpr uint64_t kPilotShare = 8;  // the pilot's photons are one in so many

  void chooseLamps(uint64_t key, const ProgressFn& progress);
  static void add(const Splat& splat, PhotonLight& to);
  SharedWithPhotons sharedBy(float samples) const;  // of a pixel, per area
  // Returns the lamp that sent the photon, which is kNoLamp where no ray can hit it.
  static constexpr uint64_t kNoLamp = UINT64_MAX;
  uint64_t follow(uint64_t key, uint64_t index, Splats& out) const;
  // The photon's ways on from a rough vertex, by its rough lobes.
  void followBounces(const Bsdf& bsdf, Vec3 flux, size_t light, Vec3 towards, Rng& rng,
                     Splats& out) const;
  void connect(const SurfacePoint& vertex, Vec3 flux, size_t light, Vec3 towards,
               Splats& out) const;

  const RayScene& rays_;
  const LightSet& lights_;
  uint64_t photons_, key_;
  float raysOfPixel_;
  unsigned bounces_;
  uint32_t width_;
  std::vector<uint64_t> dense_;  // lamps that photons are sent from, ascending
  bool chosen_ = false;          // whether dense_ says so; before, all are
  size_t lamps_ = 0;
  std::vector<PhotonLight> light_;
};

}  // namespace bnvpl
