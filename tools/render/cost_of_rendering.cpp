#include "tools/render/cost_of_rendering.h"

#include <algorithm>
#include <cmath>

#include "tools/render/film/tiles.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

namespace {

// The options of as many samples without passes, which take turns over the same film and have no
// units. The end of --time and --target-error is not known before.
Given withoutPasses(const Given& given, const Values& options) {
  const auto budget = budgetOf(options);
  if (!budget) return given;
  if (!options.has(kPassesOption)) {
    throw UsageError(
        "--estimate cannot know how many passes --time and --target-error take; give --passes");
  }
  Given plain;
  for (const auto& [name, text] : given) {
    if (name != "passes" && name != "time" && name != "target-error" && name != "adaptive" &&
        name != "pass-spp" && name != "spp" && name != "layers")
      plain.emplace_back(name, text);
  }
  if (std::ranges::any_of(layersOf(options), &Layer::ofGroups))
    plain.emplace_back("layers", "light_groups");
  plain.emplace_back("spp",
                     std::to_string(std::min(budget->spp, budget->passes * passSppOf(options))));
  return plain;
}

}  // namespace

Film filmToTry(const Film& film) {
  constexpr double kMaxPixels = 1 << 20;
  const double pixels = double(film.width) * film.height;
  if (pixels <= kMaxPixels) return film;
  const double scale = std::sqrt(kMaxPixels / pixels);
  const auto scaled = [&](uint32_t side) {
    return std::max(1u, static_cast<uint32_t>(std::lround(side * scale)));
  };
  return {scaled(film.width), scaled(film.height), film.transparent};
}

Cost costOfRendering(const Accelerator& accel, const LightSet& lights, const VplTable& lit,
                     const ImageToMake& image, const ProgressFn& progress) {
  constexpr uint64_t kMaxSpp = 64;  // as many as are taken together: more are more of the same
  const auto& [film, given, options, apart] = image;
  const Values plain = resolveRender(withoutPasses(given, options));
  const uint64_t spp = plain[kSppOption], tried = std::min(spp, kMaxSpp);
  const Film& small = accel.scene().film;
  const double pixels = double(film.width) * film.height,
               fewPixels = double(small.width) * small.height;
  CostTrial trial(cpuSecondsSoFar);
  trial.pixels = uint64_t{film.width} * film.height;
  trial.repeats = double(spp) / double(tried);
  const MemoryWatch memory;
  const Integrator integrator = makeIntegrator(accel, lights, lit, options, progress, &trial);
  UnitsToTry units;
  units.apart = apart;
  // Photons go in rounds of as many samples as 64 tiles have; some of each round are to be tried.
  if (integrator.splatPhotons) units.fewest *= 1.0 + 64.0 / double(tried);
  Cost cost = costOfUnits(
      [&](const WorkControls& controls) {
        renderSamples(accel, integrator, plain, static_cast<uint32_t>(tried), progress, controls);
      },
      trial, units);
  constexpr double kDevelopS = 5e-7;  // a pixel, its file included (measured)
  cost.workCpuS *= pixels / fewPixels * (double(spp) / double(tried));
  if (!apart) cost.workCpuS += kDevelopS * pixels;
  const double crop = double(Tiles(film).pixelsMeeting(cropOf(options, film))) / pixels;
  cost.workCpuS *= crop;
  cost.probed =
      std::min(1.0, cost.probed * (fewPixels / pixels) * (double(tried) / double(spp)) / crop);
  // What the film takes, and what an image that is developed takes besides (measured).
  const auto groups = double(lightGroupsOf(plain, accel.scene()).size());
  cost.memoryBytes += (cost.memoryBytes - memory.before()) * (pixels / fewPixels - 1.0);
  cost.memoryBytes += pixels * (60.0 + (redistributesFireflies(plain) ? 170.0 : 0.0) +
                                (budgetOf(options) ? 100.0 : 0.0) + 24.0 * groups);
  cost.memoryBytes += bytesOfHeldSamples(integrator, film, spp - tried);
  return cost;
}

}  // namespace bnvpl
