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
  // `seenLight` and `surfaceLights` may be null.
  DirectSamples(const RayScene& rays, const LightSet& lights, const SeenLight* seenLight,
                const SurfaceLights* surfaceLights, unsigned count)
      : rays_(rays),
        lights_(lights),
        seenLight_(seenLight),
        surfaceLights_(surfaceLights),
        count_(count) {}

  // What a few samples tell that are used for nothing else.
  struct Pilot {
    double variance = 0.0;  // of one, mean of the tile
    Vec3 light;             // mean
  };
  // `strata`: what the tile has learned to see; null: nothing.
  Pilot pilot(const TileSlots& tile, const LearnedStrata* strata) const;
  // Sets the direct light of the tile's samples, whose indirect light is known and took `cost`.
  // Returns what this took of each.
  double render(const TileSamples& tile, const LearnedStrata* strata, const Pilot& pilot,
                double cost, const Balance& balance) const;

 private:
  struct Light {
    Vec3 seen;       // straight
    Vec3 met;        // with `seen`, at most over mirrors and gloss
    Vec3 scattered;  // by the first rough vertex
    Vec3 all() const { return met + scattered; }
  };
  struct Stream;  // of a pixel
  Light one(uint32_t x, uint32_t y, const LearnedLight& ofTile, const Stream& stream,
            uint32_t index) const;
  struct Pixel;
  double costOf(const LearnedLight& learned) const;
  void add(const TileSlots& tile, uint32_t pixel, const LearnedLight& learned, unsigned count,
           Pixel& out, PixelDraws& draws) const;

  const RayScene& rays_;
  const LightSet& lights_;
  const SeenLight* seenLight_;
  const SurfaceLights* surfaceLights_;
  unsigned count_;
};

}  // namespace bnvpl
