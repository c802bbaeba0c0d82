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
// MIS, and bring all of what no ray can hit. Thread-safe and immutable once made.
class Caustics {
 public:
  // So many photons, > 0, from lights with power, and rays from each pixel that look for the same
  // light. Borrows rays and lights.
  Caustics(const RayScene& rays, const LightSet& lights, uint64_t photons, float raysOfPixel,
           uint64_t seed, const ProgressFn& progress);

  const PhotonLight& at(uint32_t x, uint32_t y) const { return light_[size_t{y} * width_ + x]; }
  // How rays share with them that leave a point which the camera sees directly.
  SharedWithPhotons shared(const SurfacePoint& seen) const;

 private:
  static void add(const Splat& splat, PhotonLight& to);
  SharedWithPhotons sharedBy(float samples) const;  // of a pixel, per area
  void follow(uint64_t index, Splats& out) const;
  void connect(const SurfacePoint& vertex, Vec3 flux, size_t light, Vec3 towards,
               Splats& out) const;

  const RayScene& rays_;
  const LightSet& lights_;
  uint64_t photons_, key_;
  float raysOfPixel_;
  uint32_t width_;
  std::vector<PhotonLight> light_;
};

}  // namespace bnvpl
