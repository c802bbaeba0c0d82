// Indirect light at a surface point from all VPLs: exactly, or through a cut of the light tree.
#pragma once

#include <optional>

#include "core/random.h"
#include "scene/ray_scene.h"
#include "tools/render/light_tree.h"

namespace bnvpl {

struct GatherOptions {
  bool lightcuts = true;   // else every VPL: the truth for a VPL set
  float error = 0.02f;     // largest error bound of a cluster, over the running total
  uint32_t maxCut = 1000;  // clusters
};

struct Gathered {
  Vec3 radiance;     // that leaves towards the viewer
  Vec3 clamped;      // what the bound on 1/d^2 removed
  uint32_t cut = 0;  // clusters or VPLs evaluated
  uint32_t shadowRays = 0;
};

class Gatherer {
 public:
  Gatherer(const RayScene& rays, const VplLights& vpls, const GatherOptions& options,
           uint64_t seed);

  // Thread-safe, both.
  Gathered gather(const Bsdf& bsdf) const;
  // All VPLs on average, by a few that are drawn from the light tree (Estevez & Kulla 2018): for
  // points whose light reaches the image over one random ray among many.
  Gathered sample(const Bsdf& bsdf, Rng& rng) const;

 private:
  std::optional<uint32_t> descend(uint32_t node, const Bsdf& bsdf, Rng& rng,
                                  float& probability) const;
  Gathered gatherAll(const Bsdf& bsdf) const;
  Gathered gatherCut(const Bsdf& bsdf) const;

  const RayScene& rays_;
  const VplLights& vpls_;
  GatherOptions options_;
  LightTree tree_;
};

}  // namespace bnvpl
