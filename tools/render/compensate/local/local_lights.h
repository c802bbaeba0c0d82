// The local virtual lights of a block of receivers (Davidovic et al. 2010).
//
// n of the M receivers x_k of a block, drawn at random, send m BSDF rays each. A hit y becomes a
// local light with the probability q(y), the largest share of its light that any receiver of the
// block misses. As each receiver is drawn with the probability n / M, local lights have the density
//
//   D(y) = q(y) m n / M sum over k of pdf_k(x_k -> y) |cos_y| / |x_k - y|^2     per unit area,
//
// where y is seen from all receivers, and each stands for the area 1 / D(y). A receiver x gets
//
//   sum over y of  s(|x - y|) T(x, y) L(y) / D(y),
//
// where s is the share of y's light that bounded VPLs leave out, L the light that leaves y, and
// T = f cos_x cos_y / d^2 without visibility, averaged over a sphere
// (transport/virtual_light/spherical/spherical_transfer.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/render/compensate/compensate.h"

namespace bnvpl {

struct LocalLightOptions {
  uint32_t shooters = 0, rays = 0;  // shooting receivers of a block, and rays from each
  // Radius of a local light over that of the disk that its ray stands for; 0: a point.
  float radius = 0.0f;
};

class LocalLights {
 public:
  // Borrows the arguments. `share`: s. `receivers`: those of the block, at least one. `key`: of its
  // random numbers.
  LocalLights(const Accelerator& accel, const VertexLights& vertexLights,
              const UncoveredShare& share, const LocalLightOptions& options,
              std::span<const Bsdf* const> receivers, uint64_t key, uint32_t groups);

  size_t size() const { return lights_.size(); }
  size_t raysSent() const { return raysSent_; }
  size_t shadowRays() const { return shadowRays_; }
  // Light of all local lights at a receiver; its random numbers depend on `key`.
  Gathered at(const Bsdf& receiver, uint64_t key, const LightGroupSink& groups) const;

 private:
  struct Light {
    Vec3 position, normal;
    float radius2 = 0.0f;  // 0: a point
    float area = 0.0f;     // 1 / D(y)
    Vec3 radiance = {},
         clamped = {};  // light that leaves towards the shooter; what the bound took from it
    // How the light depends on direction; unknown where empty or where `towardsShooter` is 0.
    std::optional<ExitantFactor> leaving = {};
    float towardsShooter = 0.0f;
  };

  void shootFrom(const Bsdf& shooter, uint64_t key);
  void addLight(const SurfacePoint& hit, Rng& rng);
  void findRadiance(const SurfacePoint& hit, Rng& rng, Light& light, std::span<Vec3> groups);

  const Accelerator& accel_;
  const VertexLights& vertexLights_;
  const UncoveredShare& share_;
  const LocalLightOptions& options_;
  std::span<const Bsdf* const> receivers_;
  size_t shooters_ = 0;  // n
  uint32_t groups_;
  std::vector<Light> lights_;
  std::vector<Vec3> byGroup_;  // radiance by light group, `groups_` for each light
  size_t raysSent_ = 0, shadowRays_ = 0;
};

}  // namespace bnvpl
