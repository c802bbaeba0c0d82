// Options of the methods that light a tile's samples together, and what they make of them.
#pragma once

#include "tools/render/tile/film_rays.h"
#include "tools/render/tile/tile_integrator.h"

namespace bnvpl {

inline constexpr std::string_view kIndirectIsShown = "only=all|indirect",
                                  kDirectIsShown = "only=all|direct";

inline constexpr Option kDirectSamplesOption =
    neededBy(kDirectIsShown, wholeOption("direct-samples", "0", 0, 4096, "",
                                         "camera samples of direct light to each sample; 0: by "
                                         "noise and cost; 1: the sample itself"));
constexpr Option sharersOption(std::string_view fallback, std::string_view help) {
  return neededBy(kIndirectIsShown, wholeOption("sharers", fallback, 1, 32, "", help));
}
constexpr Option controlOption(std::string_view fallback) {
  return neededBy(kIndirectIsShown,
                  choiceOption("control", fallback, "vpls|none",
                               "control variate of indirect light within a pixel: what the VPLs "
                               "know of it, along more camera rays, or none"));
}
constexpr Option balanceOption(std::string_view help) {
  return neededBy("only=all|indirect;direct-samples=0", switchOption("balance", "on", help));
}

// Where direct light comes from, by `lightRays` from a sample, and its camera samples; unless
// nothing of it is shown.
void addDirectLight(const IntegratorInputs& in, const Values& options, const FilmRays& filmRays,
                    const FilmPoints& film, unsigned lightRays, TileParts& out);
// Null where there is nothing for its photons to find. `bounces`: as of Caustics.
std::unique_ptr<const Caustics> makeCaustics(const IntegratorInputs& in, uint64_t photons,
                                             uint64_t raysOfPixel, unsigned bounces);
// By the option, with what the film's points show.
ControlFn makeControl(const IntegratorInputs& in, const FilmPoints& film);
// --balance: by the integrator without one.
Balance balanceOf(const IntegratorInputs& in, const Values& options,
                  const TileIntegrator& integrator);

}  // namespace bnvpl
