// What an image can hold beside R, G, B. A layer is one entry of kLayers (layers.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// Sums over a pixel's samples, of the values of RadianceSample; each slot is the first of its
// channels.
struct PixelSums {
  enum Slot {
    kDirect = 0,
    kIndirect = 3,
    kClamped = 6,
    kAlbedo = 9,
    kNormal = 12,
    kDepth = 15,
    kHits = 16,
    kCompensated = 17
  };
  std::array<double, 20> sum{};
};
struct PixelCounts {
  uint64_t cut = 0, shadowRays = 0, nonFinite = 0;
};

// A pixel as a layer sees it.
struct LayerPixel {
  const PixelSums& sums;
  const PixelCounts& counts;
  double perSample;  // one over the samples of a pixel
};

struct Layer {
  std::string_view name;      // of the option --layers, and before the dot of its channels
  std::string_view channels;  // "RGB": NAME.R, NAME.G, NAME.B; empty: one channel, NAME
  std::string_view help;      // with its unit
  double (*value)(const LayerPixel&, size_t channel);
  bool ofVpls = false;  // means something only where VPLs are gathered
};

std::string channelName(const Layer& layer, size_t channel);
// For --help: a line for each, with its name and help; with a line break before each.
std::string layerList();

// Of a comma-separated list of names, or "all" that the image can have; `vpls`: those of VPLs, too.
// Throws UsageError for a name that is unknown or that the image cannot have.
std::vector<const Layer*> parseLayers(const std::string& list, bool vpls = true);

}  // namespace bnvpl
