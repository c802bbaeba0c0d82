// Layers of what the camera rays of a pixel hit first: coverage, positions, objects, materials, and
// what a denoiser asks for.
//
// They come from camera rays of their own, which are the rays of the beauty's samples unless the
// image is rendered by passes or has more than kMaxFirstHitSamples a pixel. All of these layers of
// a pixel share the rays, so that coverages add up to A where the filter has no negative lobes: A
// has the filter's weights, as the light that it goes with.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "tools/render/film/layers.h"
#include "tools/render/film/tiles.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

inline constexpr uint64_t kMaxFirstHitSamples = 64;

// Values of all channels of the layers of first hits, for the tile of this index: pixel by pixel,
// in the order of the layers and of their channels.
using FirstHitValues = std::function<std::vector<float>(size_t tile)>;

// The layers of `layers` that are of first hits.
std::vector<const Layer*> firstHitLayers(std::span<const Layer* const> layers);
// Number of their channels.
size_t firstHitChannels(std::span<const Layer* const> layers);

// The function that traces a tile; empty without such layers. `filter` spreads the rays, which all
// count alike. `spp`: samples per pixel of the image. Thread-safe; borrows accel.
FirstHitValues traceFirstHits(const Accelerator& accel, const PixelFilter& filter,
                              std::span<const Layer* const> layers, uint64_t seed, uint64_t spp);

// Adds the channels to an image of the pixels in `box`. Tiles are asked for in parallel, each once.
void addFirstHits(const Tiles& tiles, std::span<const Layer* const> layers,
                  const FirstHitValues& values, const PixelBox& box, Image& image);

// Attributes that describe the layers: names and manifests of Cryptomatte.
void addFirstHitAttributes(const Scene& scene, std::span<const Layer* const> layers,
                           std::map<std::string, std::string>& attributes);

}  // namespace bnvpl
