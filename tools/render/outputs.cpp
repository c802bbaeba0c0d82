#include "tools/render/outputs.h"

#include <cmath>
#include <cstdio>

#include "formats/png_io.h"
#include "formats/tonemap.h"
#include "tools/common/exposure.h"

namespace bnvpl {

namespace {

// Exposure in EV: as given, or so that the logarithmic mean of the luminance becomes middle grey.
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

double percentOf(double part, double whole) { return whole > 0 ? 100 * part / whole : 0.0; }

}  // namespace

ExrPixelType pixelTypeOf(const Values& options) {
  return options.text("pixels") == "half" ? ExrPixelType::Half : ExrPixelType::Float;
}

void addImages(OutputSet& files, const ImagePaths& paths, const Image& image, const Values& options,
               Summary& summary) {
  const ExrPixelType pixels = pixelTypeOf(options);
  const uint64_t overflow = writeExr(files.add(paths.exr), image, pixels);
  if (pixels == ExrPixelType::Half) summary.add("beyond_half", overflow);
  if (overflow > 0) {
    printWarnings("vpl-render",
                  {std::to_string(overflow) + " values exceed half precision; use --pixels float"});
  }
  if (paths.png.empty()) return;
  const float ev = exposureOf(image, options.text("exposure"));
  writePng(files.add(paths.png), image.width, image.height,
           toSrgb8(*image.find("R"), *image.find("G"), *image.find("B"), ev));
  char line[64];
  std::snprintf(line, sizeof line, "preview at exposure %+.2f EV: ", double{ev});
  summary.add("exposure_ev", ev, line + paths.png.string());
}

void reportRender(const RenderResult& result, const Values& options, Summary& summary) {
  const FilmStats& stats = result.stats;
  const std::string& only = options.text("only");
  std::string means;
  char line[256];
  for (const auto& [name, value] :
       {std::pair{"direct", stats.direct}, {"indirect", stats.indirect}}) {
    if (only != "all" && only != name) continue;  // what is not shown is not complete
    std::snprintf(line, sizeof line, "%s %s %.5g", means.empty() ? "mean" : ",", name, value);
    means += line;
    summary.add(std::string("mean_") + name, value);
  }
  std::snprintf(line, sizeof line, "%d x %d pixels, %llu spp: %s W/(m2 sr)", result.image.width,
                result.image.height, static_cast<unsigned long long>(options.whole("spp")),
                means.c_str());
  summary.add("samples", stats.samples, line);
  if (integratorOf(options).gathers) {
    std::snprintf(line, sizeof line,
                  "of the indirect light, the clamp took %.2f %%; rays brought %.2f %% instead",
                  percentOf(stats.clamped, stats.indirect),
                  percentOf(stats.compensated, stats.indirect));
    summary.add("mean_clamped", stats.clamped, only == "direct" ? "" : line);
    summary.add("mean_compensated", stats.compensated);
    std::snprintf(line, sizeof line, "%zu VPLs with flux, mean cut %.1f, %.1f shadow rays a sample",
                  result.vpls, stats.cut, stats.shadowRays);
    summary.add("vpls", result.vpls, only == "direct" ? "" : line);
    summary.add("mean_cut", stats.cut);
    summary.add("mean_shadow_rays", stats.shadowRays);
  }
  summary.addNonFinite(stats.nonFinite, "samples");
}

}  // namespace bnvpl
