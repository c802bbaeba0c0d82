// Layers: the channels that an image can have beside R, G, B. Each is an entry of kLayers
// (layers.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/vec3.h"
#include "tools/render/sample.h"

namespace bnvpl {

// Direct light and indirect light.
using BothLights = std::array<Vec3, 2>;

// Sums over a pixel's samples of the values of RadianceSample, and the brightest of these samples.
// The enumerators are the indices of the values' first channels.
struct PixelSums {
  enum FirstChannel {
    kDirect = 0,
    kIndirect = 3,
    kClamped = 6,
    kAlbedo = 9,
    kNormal = 12,
    kDepth = 15,
    kHits = 16,
    kCompensated = 17,
    kPhotons = 20,  // the two brightest photons of the pixel, equal in all of its samples
    kToFilter = 26
  };
  static constexpr size_t kBrightest = 2;

  std::array<double, 29> sum{};
  // Brightest samples of direct light without emission, and of indirect light without photons and
  // light that a film filter smooths, in descending order of magnitude(). A sample is negative
  // where the pixel filter is, or where a control variate predicts more light than there is.
  std::array<std::array<Vec3, kBrightest>, 2> brightest{};

  Vec3 photon(size_t k) const {
    const double* of = &sum[kPhotons + 3 * k];
    return {float(of[0]), float(of[1]), float(of[2])};
  }
  void keepBrightest(size_t kind, Vec3 contribution) {
    for (Vec3& kept : brightest[kind]) {
      if (magnitude(contribution) > magnitude(kept)) std::swap(contribution, kept);
    }
  }
};
struct PixelCounts {
  uint64_t cut = 0, shadowRays = 0, nonFinite = 0;
  std::array<uint64_t, kMaxCounters> own{};  // by the methods' own counters
};

// Statistics of a pixel over the passes (passes.h).
struct PixelPasses {
  uint64_t samples = 0;            // in all passes
  std::array<double, 3> variance;  // variance of the shown R, G, B, which are means of all passes
};

// Values of a pixel from which layers are computed.
struct LayerPixel {
  const PixelSums& sums;
  const PixelCounts& counts;
  double perSample;  // factor of the sums: one over the number of samples, or of passes
  double perCount;   // factor of the counts: one over the number of samples
  const PixelPasses& passes;
  BothLights redistributed;  // change by redistributeFireflies()
};

// What a layer shows of the first hits of camera rays (first_hits.h).
enum class FirstHit {
  None,  // nothing: the layer is a value of the samples
  Coverage,
  Position,
  ObjectId,
  MaterialId,
  ObjectMatte,
  MaterialMatte,
  Albedo,  // denoiser_features.h
  Normal
};

struct Layer {
  std::string_view name;      // as in --layers, and before the dot in names of channels
  std::string_view channels;  // "RGB": NAME.R, NAME.G, NAME.B; empty: one channel, NAME
  std::string_view help;      // description with unit
  double (*value)(const LayerPixel&, size_t channel);  // null for layers of first hits
  bool ofVpls = false;                                 // exists only where VPLs are gathered
  bool ofPasses = false;  // exists only where the image is rendered by passes
  FirstHit firstHit = FirstHit::None;
  bool ofGroups = false;  // light groups (film_groups.h), which `all` leaves out
};

// The layer of the counter number `index` of the image's methods.
Layer counterLayer(const Counter& counter, size_t index);

size_t channelCount(const Layer& layer);
std::string channelName(const Layer& layer, size_t channel);
// Text for --help: one line per layer, each preceded by a line break.
std::string layerList();

// Parses a comma-separated list of names, or "all" for all layers that the image can have. `vpls`
// and `passes`: whether it gathers VPLs and is rendered by passes. `shown`: "direct" or "indirect"
// if the image shows only that light. `counters`: layers of the methods' own counters, which must
// outlive the result. Throws UsageError for a layer that is unknown or that the image cannot have.
std::vector<const Layer*> parseLayers(const std::string& list, bool vpls = true,
                                      bool passes = false, std::string_view shown = "all",
                                      std::span<const Layer> counters = {});

}  // namespace bnvpl
