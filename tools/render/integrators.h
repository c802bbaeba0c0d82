// Radiance along camera rays, split into what the image's layers need.
#pragma once

#include "tools/render/compensate/near_field/near_field.h"
#include "tools/render/gather.h"
#include "transport/specular_path.h"

namespace bnvpl {

struct RadianceSample {
  Vec3 direct;    // at most mirrors, glass and sharp lobes between the camera and the first rough
                  // vertex, and nothing between that and a light
  Vec3 indirect;  // everything else
  Vec3 clamped;   // indirect light that the bound on 1/d^2 removed from the VPLs
  Vec3 extended;  // indirect light that sampled rays brought instead; part of `indirect`
  Vec3 albedo, normal;  // of the first rough vertex
  float depth = 0.0f;   // of the first hit along the viewing axis; 0: none
  uint32_t cut = 0, shadowRays = 0;
};

// One sample of a pixel.
struct CameraSample {
  Vec3 origin, direction;
  Rng rng{0, 0};
  RadianceSample radiance;  // what an integrator finds
};

struct TileSamples : TileSlots {
  std::span<CameraSample> samples;
};

enum class Only { Everything, Direct, Indirect };

// The thesis: direct light by shadow rays, indirect light from the VPLs. What the VPLs do not carry
// is completed by sampled rays from the vertex (NearField).
class VplIntegrator {
 public:
  VplIntegrator(const RayScene& rays, const LightSet& lights, const Gatherer& gatherer,
                const NearField* nearField, unsigned nearFieldRays, Only only)
      : rays_(rays),
        lights_(lights),
        gatherer_(gatherer),
        nearField_(nearField),
        extensions_(nearField || hasSpecularLobes(rays.scene()) ? nearFieldRays : 0),
        only_(only) {}
  void render(const TileSamples& tile) const;

 private:
  struct Extension;
  void extendAll(const Bsdf& from, Vec3 throughput, uint32_t firstPoint, uint64_t pixelKey,
                 Rng& rng, RadianceSample& out) const;
  void extend(const Extension& first, Rng& rng, RadianceSample& out) const;
  NearField::Missing missingFrom(const SpecularPath& end, const ReachGrid::Lookup* near,
                                 Rng& rng) const;
  void gather(const TileSamples& tile, std::span<const SpecularPath> seen,
              std::span<const Bsdf* const> bsdf) const;

  const RayScene& rays_;
  const LightSet& lights_;
  const Gatherer& gatherer_;
  const NearField* nearField_;  // null: what the clamp and the gaps take away stays away
  unsigned extensions_;         // rays from each shaded point
  Only only_;
};

// The reference: unbiased path tracing with next-event estimation and multiple importance sampling,
// no clamping. Rough scatterings after the first rough vertex are limited to maxBounces, as a
// photon's hits.
class PathTracer {
 public:
  // `indirect`: whether also the indirect light of the points that the camera sees directly; false
  // leaves that to the LightTracer.
  PathTracer(const RayScene& rays, const LightSet& lights, unsigned maxBounces, Only only,
             bool indirect = true)
      : rays_(rays), lights_(lights), maxBounces_(maxBounces), only_(only), indirect_(indirect) {}
  void render(const TileSamples& tile) const;

 private:
  RadianceSample trace(const CameraSample& sample, Rng& rng) const;

  const RayScene& rays_;
  const LightSet& lights_;
  unsigned maxBounces_;
  Only only_;
  bool indirect_;
};

}  // namespace bnvpl
