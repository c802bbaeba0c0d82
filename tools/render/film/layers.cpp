#include "tools/render/film/layers.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/errors.h"

namespace bnvpl {

namespace {

template <PixelSums::Slot kSlot>
double meanOf(const LayerPixel& p, size_t channel) {
  return p.sums.sum[kSlot + channel] * p.perSample;
}

// Over the samples that hit something; the void is infinitely far.
double depthOf(const LayerPixel& p, size_t) {
  const double hits = p.sums.sum[PixelSums::kHits];
  return hits > 0.0 ? p.sums.sum[PixelSums::kDepth] / hits : double{INFINITY};
}

template <uint64_t PixelCounts::*kCount>
double countOf(const LayerPixel& p, size_t) {
  return static_cast<double>(p.counts.*kCount) * p.perSample;
}

constexpr std::array kLayers{
    Layer{"direct", "RGB", "light straight from the lights, W/(m2 sr)", meanOf<PixelSums::kDirect>},
    Layer{"indirect", "RGB", "all other light, W/(m2 sr)", meanOf<PixelSums::kIndirect>},
    Layer{"clamped", "RGB", "indirect light that the clamp took from VPLs, W/(m2 sr)",
          meanOf<PixelSums::kClamped>},
    Layer{"albedo", "RGB", "of the first rough vertex", meanOf<PixelSums::kAlbedo>},
    Layer{"N", "XYZ", "shading normal there", meanOf<PixelSums::kNormal>},
    Layer{"Z", "", "depth along the viewing axis, scene units", depthOf},
    Layer{"cutsize", "", "clusters or VPLs gathered, a sample", countOf<&PixelCounts::cut>},
    Layer{"shadowrays", "", "rays towards VPLs, a sample", countOf<&PixelCounts::shadowRays>},
};

}  // namespace

std::string channelName(const Layer& layer, size_t channel) {
  std::string name(layer.name);
  if (!layer.channels.empty()) name += std::string(".") + layer.channels[channel];
  return name;
}

std::string layerNames() {
  std::string names;
  for (const Layer& layer : kLayers) names += (names.empty() ? "" : ",") + std::string(layer.name);
  return names;
}

std::vector<const Layer*> parseLayers(const std::string& list) {
  std::vector<const Layer*> layers;
  std::istringstream words(list);
  std::vector<std::string> names;
  for (std::string name; std::getline(words, name, ',');) names.push_back(name);
  for (const std::string& name : names) {
    const bool all = name == "all";
    const bool known = std::ranges::any_of(kLayers, [&](const Layer& l) { return l.name == name; });
    if (!all && !known) {
      throw UsageError("--layers: unknown layer '" + name + "'; use " + layerNames() + " or all");
    }
  }
  for (const Layer& layer : kLayers) {
    const bool asked = std::ranges::any_of(
        names, [&](const std::string& n) { return n == "all" || n == layer.name; });
    if (asked) layers.push_back(&layer);
  }
  return layers;
}

}  // namespace bnvpl
