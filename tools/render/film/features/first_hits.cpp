#include "tools/render/film/features/first_hits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/film/features/cryptomatte.h"
#include "tools/render/film/features/denoiser_features.h"

namespace bnvpl {

namespace {

// What is known of a pixel.
struct PixelHits {
  size_t samples = 0, hits = 0;
  double covered = 0.0;  // sum of the filter's weights over hits, as in the pixel's light
  std::array<double, 3> position{};                    // sum over hits
  DenoiserFeatures features;                           // sum over samples
  std::vector<uint32_t> objects, materials;            // index of each hit
  std::vector<uint32_t> objectMattes, materialMattes;  // id of each hit
};

class FirstHits {
 public:
  FirstHits(const Accelerator& accel, const PixelFilter& filter,
            std::span<const Layer* const> layers, uint64_t seed, uint64_t spp)
      : accel_(accel),
        filter_(filter),
        tiles_(accel.scene().film),
        layers_(firstHitLayers(layers)),
        key_(streamKey(seed, RandomStream::PixelSamples)),
        range_{0, raysFor(spp), raysFor(spp), std::min<uint64_t>(spp, UINT32_MAX)} {
    for (const std::string& name : objectMatteNames(accel.scene()))
      objectIds_.push_back(cryptomatteId(name));
    for (const std::string& name : materialMatteNames(accel.scene()))
      materialIds_.push_back(cryptomatteId(name));
    for (const Layer* layer : layers_)
      features_ |= layer->firstHit == FirstHit::Albedo || layer->firstHit == FirstHit::Normal;
  }

  std::vector<float> tile(size_t index) const {
    const Tile tile = tiles_.at(index);
    std::vector<float> out;
    for (uint32_t p = 0; p < tile.pixels(); ++p) {
      PixelHits pixel = trace(tile.x(p), tile.y(p));
      for (const Layer* layer : layers_) append(layer->firstHit, pixel, out);
    }
    return out;
  }

 private:
  // Number of rays of a pixel. The range of samples ends with them, so that the filter's negative
  // lobes get their share.
  static uint32_t raysFor(uint64_t spp) {
    return static_cast<uint32_t>(std::min(spp, kMaxFirstHitSamples));
  }
  PixelHits trace(uint32_t x, uint32_t y) const {
    PixelHits out;
    const Scene& scene = accel_.scene();
    for (uint32_t s = 0; s < range_.end; ++s) {
      CameraSample sample = makeSample(scene, filter_, key_, range_, x, y, s);
      ++out.samples;
      SurfacePoint hit;
      if (!accel_.closestHit(sample.origin, sample.direction, hit)) continue;
      ++out.hits;
      out.covered += double{sample.weight};
      for (size_t c = 0; c < 3; ++c)
        out.position[c] += double{hit.position[int(c)]} + scene.origin[c];
      const uint32_t object = scene.objectOf(hit.triangle, hit.instance);
      out.objects.push_back(object);
      out.materials.push_back(hit.material);
      out.objectMattes.push_back(objectIds_[object]);
      out.materialMattes.push_back(materialIds_[hit.material]);
      if (features_) out.features += denoiserFeatures(accel_, hit, sample.rng);
    }
    return out;
  }

  static void append(FirstHit kind, PixelHits& pixel, std::vector<float>& out) {
    const auto add = [&](double value) { out.push_back(static_cast<float>(value)); };
    const double perSample = 1.0 / static_cast<double>(pixel.samples);
    switch (kind) {
      case FirstHit::None:
        return;
      case FirstHit::Coverage:
        return add(pixel.covered * perSample);
      case FirstHit::Position:
        for (const double sum : pixel.position)
          add(pixel.hits > 0 ? sum / static_cast<double>(pixel.hits) : 0.0);
        return;
      case FirstHit::ObjectId:
        return add(largest(pixel.objects));
      case FirstHit::MaterialId:
        return add(largest(pixel.materials));
      case FirstHit::ObjectMatte:
        return addMattes(pixel.objectMattes, pixel.samples, out);
      case FirstHit::MaterialMatte:
        return addMattes(pixel.materialMattes, pixel.samples, out);
      case FirstHit::Albedo:
        for (int c = 0; c < 3; ++c) add(double{pixel.features.albedo[c]} * perSample);
        return;
      case FirstHit::Normal:
        for (int c = 0; c < 3; ++c) add(double{pixel.features.normal[c]} * perSample);
        return;
    }
  }
  // One more than the index that covers most of the pixel, of equal ones the lowest; 0 without a
  // hit.
  static double largest(std::vector<uint32_t>& indices) {
    if (indices.empty()) return 0.0;
    return 1.0 + double(rankMattes(indices, indices.size()).front().id);
  }
  static void addMattes(std::vector<uint32_t>& ids, size_t samples, std::vector<float>& out) {
    std::vector<MatteRank> ranks = rankMattes(ids, samples);
    ranks.resize(kMatteRanks);
    for (const MatteRank& rank : ranks) {
      out.push_back(std::bit_cast<float>(rank.id));
      out.push_back(rank.coverage);
    }
  }

  const Accelerator& accel_;
  PixelFilter filter_;
  Tiles tiles_;
  std::vector<const Layer*> layers_;
  uint64_t key_;
  SampleRange range_;
  std::vector<uint32_t> objectIds_, materialIds_;
  bool features_ = false;
};

}  // namespace

std::vector<const Layer*> firstHitLayers(std::span<const Layer* const> layers) {
  std::vector<const Layer*> out;
  std::ranges::copy_if(layers, std::back_inserter(out),
                       [](const Layer* layer) { return layer->firstHit != FirstHit::None; });
  return out;
}

size_t firstHitChannels(std::span<const Layer* const> layers) {
  size_t channels = 0;
  for (const Layer* layer : firstHitLayers(layers)) channels += channelCount(*layer);
  return channels;
}

FirstHitValues traceFirstHits(const Accelerator& accel, const PixelFilter& filter,
                              std::span<const Layer* const> layers, uint64_t seed, uint64_t spp) {
  if (firstHitLayers(layers).empty()) return {};
  const auto hits = std::make_shared<const FirstHits>(accel, filter, layers, seed, spp);
  return [hits](size_t tile) { return hits->tile(tile); };
}

void addFirstHits(const Tiles& tiles, std::span<const Layer* const> layers,
                  const FirstHitValues& values, const PixelBox& box, Image& image) {
  const size_t first = image.channels.size(), count = firstHitChannels(layers);
  for (const Layer* layer : firstHitLayers(layers)) {
    for (size_t c = 0; c < channelCount(*layer); ++c) image.add(channelName(*layer, c));
  }
  if (count == 0) return;
  parallelFor(tiles.count(), 1, [&](size_t t) {
    if (!tiles.meets(t, box)) return;
    const Tile tile = tiles.at(t);
    const std::vector<float> of = values(t);
    for (uint32_t p = 0; p < tile.pixels(); ++p) {
      const auto x = static_cast<int>(tile.x(p)), y = static_cast<int>(tile.y(p));
      if (x < box.x0 || x >= box.x1 || y < box.y0 || y >= box.y1) continue;
      const auto pixel = static_cast<size_t>((y - box.y0) * image.width + x - box.x0);
      for (size_t c = 0; c < count; ++c) image.channels[first + c].data[pixel] = of[p * count + c];
    }
  });
}

void addFirstHitAttributes(const Scene& scene, std::span<const Layer* const> layers,
                           std::map<std::string, std::string>& attributes) {
  for (const Layer* layer : firstHitLayers(layers)) {
    const std::string name(layer->name);
    if (layer->firstHit == FirstHit::ObjectMatte)
      addMatteAttributes(name, objectMatteNames(scene), attributes);
    if (layer->firstHit == FirstHit::MaterialMatte)
      addMatteAttributes(name, materialMatteNames(scene), attributes);
  }
}

}  // namespace bnvpl
