// Camera samples for direct light alone. Where indirect light costs hundreds of rays per sample and
// direct light has most of the noise, as behind windows or lamp shades, further samples of both
// would waste time.
#pragma once

#include "tools/render/pixel_filter.h"
#include "tools/render/sample.h"
#include "tools/render/tile/allocation/sample_allocation.h"
#include "tools/render/tile/direct/visible_emission.h"
#include "transport/direct_light/direct_light.h"

namespace bnvpl {

class DirectSamples {
 public:
  // `count`: direct samples for each camera sample; 0: as many as a pilot finds efficient. The
  // pilot's samples are used for nothing else, so that the mean is unbiased. `alone`: camera
  // samples have no rays of their own; the direct samples also fill in depth, normal and albedo.
  // `visibleEmission` and `spatialLights` may be null.
  DirectSamples(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
                const VisibleEmission* visibleEmission, const SpatialLightSampler* spatialLights,
                unsigned count, bool alone)
      : accel_(accel),
        lights_(lights),
        filter_(filter),
        visibleEmission_(visibleEmission),
        spatialLights_(spatialLights),
        count_(count),
        alone_(alone) {}

  struct Pilot {
    double variance = 0.0;  // per direct sample, mean over the tile
    Vec3 light;             // mean over the tile
    float bsdfRays = 1.0f;  // efficient mean number from each shading point, at most 1
  };
  // `strata`: the tile's learned distribution of lights; may be null.
  Pilot pilot(const TileLayout& tile, const LearnedStrata* strata) const;
  // Sets the direct light of the tile's camera samples. `paths`: their camera paths. `cost`: cost
  // of a sample without its direct light. Returns the cost of a sample's direct samples.
  double render(const TileSamples& tile, std::span<const SpecularPath> paths,
                const LearnedStrata* strata, const Pilot& pilot, double cost,
                const SampleAllocation& allocation) const;

 private:
  // Whether emission that the camera samples' own paths meet counts as that of one more ray. Where
  // a tile chooses the number of direct samples, these paths decide on it by their indirect light:
  // a path that ends on a lamp has none. Its emission would get a weight that depends on it.
  bool countsCameraPaths() const { return count_ > 0 && !alone_; }
  // The direct light of a sample, or a sum over samples.
  struct Light {
    Vec3 emission;      // directly visible emission
    Vec3 onCameraPath;  // on the camera path: `emission`, and light at specular vertices
    // Light that the shading point scatters, by shadow rays and by BSDF rays.
    Vec3 byLight, byBsdf;
    float weight = 1.0f;  // the pixel filter's, in all of the light; meaningless in a sum
    Vec3 all() const { return onCameraPath + byLight + byBsdf; }
    Vec3 unweightedLight() const { return unweighted(all(), weight); }
    Light& operator+=(const Light& other);
  };
  // Rays from a shading point.
  struct Rays {
    LearnedLight lights;
    float bsdf = 1.0f;  // mean number, at most 1
  };
  struct RandomNumbers;
  // One direct sample of a pixel, the index-th by `numbers`. `which`: see PixelFilter. `layers`:
  // receives depth, normal and albedo; may be null. `onCameraPath` and `lit` receive the light by
  // group that the camera path meets and that the shading point scatters.
  Light sample(uint32_t x, uint32_t y, const Rays& rays, const RandomNumbers& numbers,
               uint32_t index, const PixelFilter::SampleOfSet& which,
               RadianceSample* layers = nullptr, const SampleGroups& onCameraPath = {},
               const LightGroupSink& lit = {}) const;
  Vec3 bsdfRay(const Bsdf& bsdf, Vec3 throughput, const Rays& rays, const LearnedLight& learned,
               Rng& rng, const LightGroupSink& lit) const;
  struct Pixel;
  double costOf(const Rays& rays) const;
  void add(const TileSamples& tile, uint32_t pixel, const Rays& rays, unsigned count, Pixel& out,
           PixelMoments& moments) const;
  void addMore(const TileSamples& tile, const Rays& rays, double cost,
               const SampleAllocation& allocation, std::span<const PixelMoments> moments,
               std::span<Pixel> pixels) const;
  void store(const TileSamples& tile, uint32_t pixel, const LearnedStrata* strata,
             const Pixel& from) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  PixelFilter filter_;
  const VisibleEmission* visibleEmission_;
  const SpatialLightSampler* spatialLights_;
  unsigned count_;
  bool alone_;
};

}  // namespace bnvpl
