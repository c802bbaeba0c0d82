// What an image can hold beside R, G, B. A layer is one entry of kLayers (layers.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

// Of direct light, and of indirect light.
using BothLights = std::array<Vec3, 2>;

// Sums over a pixel's samples, of the values of RadianceSample, each slot being the first of its
// channels; and of the brightest samples what each adds to them.
struct PixelSums {
  enum Slot {
    kDirect = 0,
    kIndirect = 3,
    kClamped = 6,
    kAlbedo = 9,
    kNormal = 12,
    kDepth = 15,
    kHits = 16,
    kCompensated = 17,
    kPhotons = 20  // the two brightest photons, which are the same for all samples
  };
  static constexpr size_t kBrightest = 2;

  std::array<double, 26> sum{};
  // Of direct light but what the camera ray itself meets, and of indirect light but what
  // photons bring; by the mean of the channels, the brightest first.
  std::array<std::array<Vec3, kBrightest>, 2> brightest{};

  Vec3 photon(size_t k) const {
    const double* of = &sum[kPhotons + 3 * k];
    return {float(of[0]), float(of[1]), float(of[2])};
  }
  void keepBrightest(size_t kind, Vec3 brought) {
    for (Vec3& kept : brightest[kind]) {
      if (mean(brought) > mean(kept)) std::swap(brought, kept);
    }
  }
};
struct PixelCounts {
  uint64_t cut = 0, shadowRays = 0, nonFinite = 0;
};

// What passes over the film know of a pixel beside the sums of their means.
struct PixelPasses {
  uint64_t samples = 0;            // of all passes
  std::array<double, 3> variance;  // of the shown R, G, B, the mean of all passes
};

// A pixel as a layer sees it.
struct LayerPixel {
  const PixelSums& sums;
  const PixelCounts& counts;
  double perSample;  // of the sums: one over the samples of a pixel, or the passes
  double perCount;   // of the counts: one over the samples
  const PixelPasses& passes;
  BothLights redistributed;  // what redistributeFireflies() adds
};

struct Layer {
  std::string_view name;      // of the option --layers, and before the dot of its channels
  std::string_view channels;  // "RGB": NAME.R, NAME.G, NAME.B; empty: one channel, NAME
  std::string_view help;      // with its unit
  double (*value)(const LayerPixel&, size_t channel);
  bool ofVpls = false;    // means something only where VPLs are gathered
  bool ofPasses = false;  // only where the image is made by passes
};

std::string channelName(const Layer& layer, size_t channel);
// For --help: a line for each, with its name and help; with a line break before each.
std::string layerList();

// Of a comma-separated list of names, or "all" that the image can have; `vpls`: those of VPLs, too;
// `passes`: those of passes; `shown`: "direct" or "indirect" where the image shows that light
// alone. Throws UsageError for a name that is unknown or that the image cannot have.
std::vector<const Layer*> parseLayers(const std::string& list, bool vpls = true,
                                      bool passes = false, std::string_view shown = "all");

}  // namespace bnvpl
