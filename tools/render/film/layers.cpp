#include "tools/render/film/layers.h"

#include <cmath>
#include <set>
#include <sstream>

#include "core/errors.h"

namespace bnvpl {

namespace {

template <PixelSums::FirstChannel kFirst>
double meanOf(const LayerPixel& p, size_t channel) {
  return p.sums.sum[kFirst + channel] * p.perSample;
}

template <PixelSums::FirstChannel kFirst, size_t kKind>
double lightOf(const LayerPixel& p, size_t channel) {
  return meanOf<kFirst>(p, channel) + double{p.redistributed[kKind][channel]};
}

// Mean depth of the samples that hit a surface, or infinity if none did.
double depthOf(const LayerPixel& p, size_t) {
  const double hits = p.sums.sum[PixelSums::kHits];
  return hits > 0.0 ? p.sums.sum[PixelSums::kDepth] / hits : double{INFINITY};
}

template <uint64_t PixelCounts::*kCount>
double countOf(const LayerPixel& p, size_t) {
  return static_cast<double>(p.counts.*kCount) * p.perCount;
}

double errorOf(const LayerPixel& p, size_t channel) {
  return std::sqrt(p.passes.variance[channel]);
}

double samplesOf(const LayerPixel& p, size_t) { return static_cast<double>(p.passes.samples); }

constexpr std::array kLayers{
    Layer{"direct", "RGB", "direct light, W/(m2 sr)", lightOf<PixelSums::kDirect, 0>},
    Layer{"indirect", "RGB", "all other light, W/(m2 sr)", lightOf<PixelSums::kIndirect, 1>},
    Layer{"clamped", "RGB", "indirect light of VPLs that clamping removed, W/(m2 sr)",
          meanOf<PixelSums::kClamped>, true},
    Layer{"albedo", "RGB", "reflectance of the first rough vertex", meanOf<PixelSums::kAlbedo>},
    Layer{"N", "XYZ", "shading normal of the first rough vertex", meanOf<PixelSums::kNormal>},
    Layer{"Z", "", "depth along the viewing axis, scene units", depthOf},
    Layer{"cutsize", "", "clusters or VPLs gathered per sample", countOf<&PixelCounts::cut>, true},
    Layer{"shadowrays", "", "shadow rays to VPLs per sample", countOf<&PixelCounts::shadowRays>,
          true},
    Layer{"error", "RGB",
          "standard error of R, G, B between passes, before fireflies are redistributed, W/(m2 sr)",
          errorOf, false, true},
    Layer{"samples", "", "samples of all passes", samplesOf, false, true},
};

}  // namespace

std::string channelName(const Layer& layer, size_t channel) {
  std::string name(layer.name);
  if (!layer.channels.empty()) name += std::string(".") + layer.channels[channel];
  return name;
}

std::string layerList() {
  std::string lines;
  for (const Layer& layer : kLayers)
    lines += "\n  " + std::string(layer.name) + ": " + std::string(layer.help);
  return lines;
}

std::vector<const Layer*> parseLayers(const std::string& list, bool vpls, bool passes,
                                      std::string_view shown) {
  std::istringstream words(list);
  std::set<std::string, std::less<>> names;
  for (std::string name; std::getline(words, name, ',');) names.insert(name);
  const bool all = names.erase("all") > 0;
  std::vector<const Layer*> layers;
  std::string known;
  for (const Layer& layer : kLayers) {
    const bool named = names.erase(std::string(layer.name)) > 0;
    if (named && layer.ofVpls && !vpls) {
      throw UsageError("--layers: '" + std::string(layer.name) +
                       "' tells of gathered VPLs, of which the image has none; leave it out");
    }
    if (named && layer.ofPasses && !passes) {
      throw UsageError("--layers: '" + std::string(layer.name) +
                       "' is known of passes; add --time, --target-error or --passes");
    }
    const bool light = layer.name == "direct" || layer.name == "indirect";
    const bool isShown = shown == "all" || !light || layer.name == shown;
    if (named && !isShown) {
      throw UsageError("--layers: '" + std::string(layer.name) + "' is not complete with --only " +
                       std::string(shown) + "; leave one of them out");
    }
    const bool possible = isShown && (vpls || !layer.ofVpls) && (passes || !layer.ofPasses);
    if (named || (all && possible)) layers.push_back(&layer);
    known += std::string(layer.name) + ", ";
  }
  if (!names.empty())
    throw UsageError("--layers: unknown layer '" + *names.begin() + "'; use " + known + "or all");
  return layers;
}

}  // namespace bnvpl
