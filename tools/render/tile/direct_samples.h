// Camera samples for direct light alone. Where indirect light costs hundreds of rays a sample and
// direct light, through windows or a shade, has most of the noise, a sample of both is a bad deal.
#pragma once

#include "tools/render/integrator/integrator.h"
#include "tools/render/tile/balance.h"
#include "tools/render/tile/seen_light.h"
#include "transport/direct_light.h"

namespace bnvpl {

class DirectSamples {
 public:
  // `count`: camera samples of direct light for each sample; 0: as many as are worth it, by pilots,
  // so that the mean stays unbiased.
  // `alone`: samples have nothing but their direct light, and no camera ray of their own; what the
  // film's other layers show of them is seen by these.
  // `seenLight` and `surfaceLights` may be null.
  DirectSamples(const RayScene& rays, const LightSet& lights, const SeenLight* seenLight,
                const SurfaceLights* surfaceLights, unsigned count, bool alone)
      : rays_(rays),
        lights_(lights),
        seenLight_(seenLight),
        surfaceLights_(surfaceLights),
        count_(count),
        alone_(alone) {}

  // What a few samples tell that are used for nothing else.
  struct Pilot {
    double variance = 0.0;  // of one, mean of the tile
    Vec3 light;             // mean
    float bsdfRays = 1.0f;  // from each rough vertex, at most 1: as many as are worth it
  };
  // `strata`: what the tile has learned to see; null: nothing.
  Pilot pilot(const TileSlots& tile, const LearnedStrata* strata) const;
  // Sets the direct light of the tile's samples, whose indirect light is known and took `cost`, and
  // adds to what their own camera rays, `paths`, have met. Returns what this took of each.
  double render(const TileSamples& tile, std::span<const SpecularPath> paths,
                const LearnedStrata* strata, const Pilot& pilot, double cost,
                const Balance& balance) const;

 private:
  struct Light {
    Vec3 seen;             // straight
    Vec3 met;              // with `seen`, at most over mirrors and gloss
    Vec3 byLight, byBsdf;  // what the first rough vertex scatters, found by rays of either kind
    Vec3 all() const { return met + byLight + byBsdf; }
    Light& operator+=(const Light& other);
  };
  struct Rays {  // from the first rough vertex
    LearnedLight lights;
    float byBsdf = 1.0f;  // in the mean, at most 1
  };
  struct Stream;  // of a pixel
  // `shown`: null, or what other layers show of the sample.
  Light one(uint32_t x, uint32_t y, const Rays& rays, const Stream& stream, uint32_t index,
            RadianceSample* shown = nullptr) const;
  struct Pixel;
  double costOf(const Rays& rays) const;
  void add(const TileSamples& tile, uint32_t pixel, const Rays& rays, unsigned count, Pixel& out,
           PixelDraws& draws) const;

  const RayScene& rays_;
  const LightSet& lights_;
  const SeenLight* seenLight_;
  const SurfaceLights* surfaceLights_;
  unsigned count_;
  bool alone_;
};

}  // namespace bnvpl
