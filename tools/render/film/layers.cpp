#include "tools/render/film/layers.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "core/errors.h"
#include "tools/render/film/features/cryptomatte.h"

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

template <size_t kIndex>
double ownCountOf(const LayerPixel& p, size_t) {
  return static_cast<double>(p.counts.own[kIndex]) * p.perCount;
}

double errorOf(const LayerPixel& p, size_t channel) {
  return std::sqrt(p.passes.variance[channel]);
}

double samplesOf(const LayerPixel& p, size_t) { return static_cast<double>(p.passes.samples); }

constexpr Layer firstHitLayer(std::string_view name, std::string_view channels,
                              std::string_view help, FirstHit firstHit) {
  return {name, channels, help, nullptr, false, false, firstHit};
}

bool isMatte(const Layer& layer) {
  return layer.firstHit == FirstHit::ObjectMatte || layer.firstHit == FirstHit::MaterialMatte;
}

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
    Layer{"light_groups", "RGB",
          "the light of each light group of the scene, in light_NAME, W/(m2 sr); not in all",
          nullptr, false, false, FirstHit::None, true},
    firstHitLayer("A", "", "coverage: share of the pixel in which camera rays hit geometry",
                  FirstHit::Coverage),
    firstHitLayer("P", "XYZ",
                  "position of the first hit in world space, mean of the rays that hit; 0 without "
                  "a hit",
                  FirstHit::Position),
    firstHitLayer("objectid", "",
                  "1 for the first object of the scene, and so on: the one that covers most of the "
                  "pixel; 0 for none",
                  FirstHit::ObjectId),
    firstHitLayer("materialid", "", "the same for materials", FirstHit::MaterialId),
    firstHitLayer("CryptoObject", "RGBA",
                  "Cryptomatte of objects: six ids and coverages in CryptoObject00 to 02",
                  FirstHit::ObjectMatte),
    firstHitLayer("CryptoMaterial", "RGBA", "Cryptomatte of materials", FirstHit::MaterialMatte),
    firstHitLayer("denoise_albedo", "RGB",
                  "albedo for denoisers: of the first vertex that is not perfectly specular, "
                  "metals and coats included",
                  FirstHit::Albedo),
    firstHitLayer("denoise_normal", "XYZ", "shading normal for denoisers, of the same vertex",
                  FirstHit::Normal),
};

}  // namespace

Layer counterLayer(const Counter& counter, size_t index) {
  constexpr std::array<double (*)(const LayerPixel&, size_t), kMaxCounters> kValues{
      ownCountOf<0>, ownCountOf<1>, ownCountOf<2>, ownCountOf<3>};
  return {counter.name, "", counter.help, kValues.at(index), true};
}

size_t channelCount(const Layer& layer) {
  return std::max<size_t>(1, layer.channels.size()) * (isMatte(layer) ? kMatteLayers : 1);
}

std::string channelName(const Layer& layer, size_t channel) {
  std::string name(layer.name);
  if (isMatte(layer)) {
    const size_t channels = layer.channels.size();
    name += "0" + std::to_string(channel / channels);
    channel %= channels;
  }
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
                                      std::string_view shown, std::span<const Layer> counters) {
  std::istringstream words(list);
  std::set<std::string, std::less<>> names;
  for (std::string name; std::getline(words, name, ',');) names.insert(name);
  const bool all = names.erase("all") > 0;
  std::vector<const Layer*> layers;
  std::string known;
  const auto consider = [&](const Layer& layer) {
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
    const bool possible =
        isShown && (vpls || !layer.ofVpls) && (passes || !layer.ofPasses) && !layer.ofGroups;
    if (named || (all && possible)) layers.push_back(&layer);
    known += std::string(layer.name) + ", ";
  };
  std::ranges::for_each(kLayers, consider);
  std::ranges::for_each(counters, consider);
  if (!names.empty())
    throw UsageError("--layers: unknown layer '" + *names.begin() + "'; use " + known + "or all");
  return layers;
}

}  // namespace bnvpl
