#include "tools/render/outputs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/hash.h"
#include "formats/image/png_io.h"
#include "formats/image/tonemap.h"
#include "tools/common/options/exposure.h"
#include "tools/common/run/result_warning.h"
#include "tools/render/counter_layers.h"
#include "tools/render/image_camera.h"
#include "tools/render/integrator/integrator_method.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

namespace {

// Exposure in EV: the given one, or the one that maps the logarithmic mean luminance to middle
// grey.
float exposureOf(const Image& image, const std::string& text) {
  if (const auto given = parseExposure(text)) return static_cast<float>(*given);
  const std::vector<float>&r = *image.find("R"), &g = *image.find("G"), &b = *image.find("B");
  double logSum = 0.0;
  size_t lit = 0;
  for (size_t i = 0; i < r.size(); ++i) {
    const double y = double{luminance({r[i], g[i], b[i]})};
    if (y > 0.0) {
      logSum += std::log2(y);
      ++lit;
    }
  }
  const double ev = lit > 0 ? std::log2(0.18) - logSum / double(lit) : 0.0;
  return static_cast<float>(std::round(ev * 4.0) / 4.0);
}

void writePreview(AtomicFile& file, const Image& image, float ev) {
  const auto provenance = image.attributes.find("bnvpl.provenance");
  const PixelBox box = dataWindowOf(image);
  const std::vector<uint8_t> film =
      toSrgb8(*image.find("R"), *image.find("G"), *image.find("B"), ev);
  std::vector<uint8_t> rgb8;
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = film.begin() + std::ptrdiff_t{3} * y * image.width;
    rgb8.insert(rgb8.end(), row + std::ptrdiff_t{3} * box.x0, row + std::ptrdiff_t{3} * box.x1);
  }
  writePng(file, box.x1 - box.x0, box.y1 - box.y0, rgb8, 3,
           provenance == image.attributes.end() ? std::string() : provenance->second);
}

// A black image is usually a mistake.
void warnOfBlack(const Image& image) {
  for (const char* channel : {"R", "G", "B"}) {
    if (std::ranges::any_of(*image.find(channel), [](float v) { return v != 0.0f; })) return;
  }
  warnOfResult(
      "the image is black: the camera looks away from everything, or no light comes to "
      "what it sees; vpl-inspect doctor SCENE tells which, and what to change");
}

// Rooms lit around two corners are 20 to 30 times darker than even light.
constexpr double kDark = 70.0;

void warnOfDark(const RenderResult& result) {
  const double shown = result.stats.direct + result.stats.indirect;
  if (!(shown > 0.0) || kDark * shown > result.evenRadiance) return;
  warnOfResult("the image is " + formatSi(result.evenRadiance / shown) +
               " times darker than the power of the lights would make it if it fell evenly on "
               "all surfaces; vpl-inspect doctor SCENE tells where their light goes");
}

double percentOf(double part, double whole) { return whole > 0 ? 100 * part / whole : 0.0; }

}  // namespace

double bytesPerPixelOf(const Values& options, size_t groups) {
  // Sums and image; layers and what tiles learn of the lights may take twice as much besides.
  double bytes = 360;  // measured, as are the others
  if (redistributesFireflies(options)) bytes += 165;
  if (budgetOf(options)) bytes += 76;  // sums over passes
  const bool photons = integratorOf(options).splatsPhotons;
  if (photons) bytes += 168;  // exact sums of photons
  if (groups > 0) bytes += 50.0 + double(groups) * (96 + (photons ? 168 : 0));
  return bytes;
}

ExrPixelType pixelTypeOf(const Values& options) {
  return options.meet(valueIs(kPixelsOption, "half")) ? ExrPixelType::Half : ExrPixelType::Float;
}

void addImages(OutputSet& files, const ImagePaths& paths, const Image& image, const Values& options,
               Summary& summary) {
  const ExrPixelType pixels = pixelTypeOf(options);
  const HalfLosses losses = writeExr(files.add(paths.exr), image, pixels);
  if (pixels == ExrPixelType::Half) {
    summary.add("beyond_half", losses.beyond);
    summary.add("below_half", losses.below);
  }
  const auto warn = [](uint64_t count, const char* what) {
    if (count == 0) return;
    warnOfResult(std::to_string(count) + what + "; use --pixels float");
  };
  warn(losses.beyond, " values exceed half precision");
  warn(losses.below, " values are too small for half precision and became 0");
  warnOfBlack(image);
  if (paths.png.empty()) return;
  const float ev = exposureOf(image, options[kExposureOption]);
  writePreview(files.add(paths.png), image, ev);
  char line[64];
  std::snprintf(line, sizeof line, "preview at exposure %+.2f EV: ", double{ev});
  summary.add("exposure_ev", ev, line + paths.png.string());
}

void renewPreview(const fs::path& png, const Image& image, const Values& options) {
  AtomicFile file(png);
  writePreview(file, image, exposureOf(image, options[kExposureOption]));
  file.commit();
}

Json resumableOptions(const Values& options) {
  Json record = recordOf(renderSpec(), options);
  if (std::ranges::any_of(layersOf(options), &Layer::ofGroups)) record["light_groups"] = true;
  if (budgetOf(options)) {
    // Records are compared including the order of their keys, so `passes` always comes last.
    for (const char* countedBy : {"spp", "passes"}) record.erase(countedBy);
    record["passes"] = "any number";
  }
  return record;
}

Values optionsMade(const RenderResult& result, const Given& given) {
  Given all = given;
  if (result.passes) {
    all.emplace_back("passes", std::to_string(result.passes->passes));
    all.emplace_back("spp", std::to_string(result.passes->passes * result.passes->passSpp));
    if (result.passes->passSpp != kPassSpp)
      all.emplace_back("pass-spp", std::to_string(result.passes->passSpp));
  }
  return resolveRender(all);
}

void finishImage(RenderResult& result, const Values& made, const std::string& provenance) {
  auto& attributes = result.image.attributes;
  attributes["software"] = "bnvpl " BNVPL_VERSION;
  attributes["bnvpl.samplesPerPixel"] = std::to_string(made[kSppOption]);
  if (result.passes) {
    attributes["bnvpl.passes"] = std::to_string(result.passes->passes);
    char error[32];
    std::snprintf(error, sizeof error, "%.6g", result.passes->error);
    attributes["bnvpl.relativeError"] = error;
  }
  attributes["bnvpl.provenance"] = provenance;
  attributes[kImageHashAttribute] = hashText(hashImage(result.image, pixelTypeOf(made)));
}

Json withLayers(Json run, const Values& options) {
  run["layers"] = options[kLayersKey];
  return run;
}

Json sourcesOf(const RenderResult& result) {
  return {{"vpls", result.vpls},
          {"emission_points", result.emissionPoints},
          {"light_groups", result.groups},
          {"camera", toJson(*result.image.camera)},
          {"attributes", result.image.attributes}};
}

void takeSources(const Json& sources, RenderResult& result) {
  result.vpls = fieldOf<size_t>(sources, "vpls");
  result.groups = fieldOf<std::vector<std::string>>(sources, "light_groups");
  result.emissionPoints = fieldOf<size_t>(sources, "emission_points");
  result.image.camera = imageCameraOf(fieldOf<Json>(sources, "camera"));
  result.image.attributes = fieldOf<std::map<std::string, std::string>>(sources, "attributes");
}

namespace {

void reportPasses(const PassesDone& passes, const Values& options, Summary& summary) {
  char line[256];
  const std::string ofSpp =
      passes.passSpp == kPassSpp ? "" : " --pass-spp " + std::to_string(passes.passSpp);
  std::snprintf(line, sizeof line,
                "%llu passes of %u spp in %.1f s: estimated relative error %.3g; --passes %llu%s%s "
                "repeats this image",
                static_cast<unsigned long long>(passes.passes), passes.passSpp, passes.timeS,
                passes.error, static_cast<unsigned long long>(passes.passes), ofSpp.c_str(),
                options[kAdaptiveOption] ? "" : " --adaptive off");
  summary.add("passes", passes.passes, line);
  summary.add("pass_spp", passes.passSpp);
  summary.add("relative_error", passes.error);
  summary.add("passes_time_s", passes.timeS);
  summary.add("ended_by", passes.endedBy);
  const double wantedS = options.has(kTimeOption) ? options[kTimeOption] : INFINITY;
  if (passes.passes == kMinPasses && passes.timeS > 1.1 * wantedS) {
    std::snprintf(
        line, sizeof line,
        "two passes, the fewest, ended after %.1f s instead of --time's %.6g; choose a smaller "
        "--size, or a lower quality",
        passes.timeS, wantedS);
    warnOfResult(line);
  }
}

void reportGathered(const RenderResult& result, const Values& options, Summary& summary) {
  const FilmStats& stats = result.stats;
  const bool shown = options.meet(kIndirectIsShown);
  char line[256];
  std::snprintf(
      line, sizeof line, "indirect light: clamping removed %.2f %%, compensation added %.2f %%",
      percentOf(stats.clamped, stats.indirect), percentOf(stats.compensated, stats.indirect));
  summary.add("mean_clamped", stats.clamped, shown ? line : "");
  summary.add("mean_compensated", stats.compensated);
  const CompensateMethod* compensate = compensationOf(options);
  if (compensate && compensate->oneSize) {
    const double restored = stats.clamped > 0.0 ? stats.compensated / stats.clamped : 1.0;
    std::snprintf(line, sizeof line, "compensation restored %.1f %% of the clamped light",
                  100.0 * restored);
    summary.add("restored_over_removed", restored, shown ? line : "");
  }
  std::snprintf(
      line, sizeof line,
      "%zu VPLs with flux and %zu emission points, mean cut %.1f, %.1f shadow rays a sample",
      result.vpls, result.emissionPoints, stats.cut, stats.shadowRays);
  summary.add("vpls", result.vpls, shown ? line : "");
  summary.add("emission_points", result.emissionPoints);
  summary.add("mean_cut", stats.cut);
  summary.add("mean_shadow_rays", stats.shadowRays);
  for (const FilmCount& c : result.filmCounts) {
    std::snprintf(line, sizeof line, "%.0f %s", c.value, std::string(c.unit).c_str());
    summary.add(std::string(c.name), c.value, line);
  }
  const std::vector<Counter> counters = countersOf(options);
  for (size_t k = 0; k < counters.size(); ++k) {
    std::snprintf(line, sizeof line, "%.1f %s a sample", stats.own[k],
                  std::string(counters[k].unit).c_str());
    summary.add("mean_" + std::string(counters[k].name), stats.own[k], line);
  }
}

}  // namespace

void warnOfIdle(const RenderResult& result, const Given& given) {
  for (const std::string_view name : result.idle) {
    if (textGiven(given, name))
      warnOfResult("--" + std::string(name) + " had no effect in this scene; leave it out");
  }
}

void reportRender(const RenderResult& result, const Values& options, Summary& summary) {
  const FilmStats& stats = result.stats;
  const std::string& only = options[kOnlyOption];
  std::string means;
  char line[256];
  for (const auto& [name, value] :
       {std::pair{"direct", stats.direct}, {"indirect", stats.indirect}}) {
    if (only != "all" && only != name) continue;  // light that is not shown is incomplete
    std::snprintf(line, sizeof line, "%s %s %.5g", means.empty() ? "mean" : ",", name, value);
    means += line;
    summary.add(std::string("mean_") + name, value);
  }
  const PixelBox box = dataWindowOf(result.image);
  std::snprintf(line, sizeof line, "%d x %d pixels%s, %llu spp: %s W/(m2 sr)", box.x1 - box.x0,
                box.y1 - box.y0, result.image.dataWindow ? " of the film" : "",
                static_cast<unsigned long long>(options[kSppOption]), means.c_str());
  summary.add("samples", stats.samples, line);
  if (result.passes) reportPasses(*result.passes, options, summary);
  if (integratorOf(options).gathersVpls) reportGathered(result, options, summary);
  const CausticStats& caustics = result.caustics;
  if (caustics.useful.guided > 0.0) {
    std::snprintf(
        line, sizeof line,
        "guided emission: %.3g %% of the caustic photons come into view; by power it would "
        "be %.3g %%",
        100.0 * caustics.useful.guided, 100.0 * caustics.useful.byPower);
    summary.add("useful_caustic_photons",
                {{"by_power", caustics.useful.byPower}, {"guided", caustics.useful.guided}}, line);
  }
  if (caustics.emitters > 0) {
    std::snprintf(line, sizeof line,
                  "caustics of %zu of %zu lights and parts of the sky come from near-field rays "
                  "alone: too few of their photons come into view",
                  caustics.sparseEmitters, caustics.emitters);
    summary.add("emitters", caustics.emitters);
    summary.add("emitters_without_photons", caustics.sparseEmitters,
                caustics.sparseEmitters > 0 ? line : "");
  }
  if (only == "all") warnOfDark(result);
  summary.addNonFinite(stats.nonFinite, "samples");
}

}  // namespace bnvpl
