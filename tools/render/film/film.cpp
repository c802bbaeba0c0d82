#include "tools/render/film/film.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "tools/common/streams.h"
#include "tools/render/film/splats.h"
#include "transport/camera.h"

namespace bnvpl {

namespace {

constexpr uint32_t kSlotsAtOnce = 16;   // samples of each pixel that are held in memory together
constexpr uint32_t kSlotsPerPass = 64;  // over the whole image; work stops between tiles of a pass

void addTo(PixelSums& p, size_t slot, Vec3 v) {
  p.sum[slot] += double{v.x};
  p.sum[slot + 1] += double{v.y};
  p.sum[slot + 2] += double{v.z};
}

bool isFinite(const RadianceSample& r) {
  return isFinite(r.direct + r.indirect) && isFinite(r.clamped) && isFinite(r.compensated) &&
         isFinite(r.albedo) && isFinite(r.normal) && std::isfinite(r.depth);
}

void addSample(const RadianceSample& r, PixelSums& pixel, PixelCounts& counts) {
  if (!isFinite(r)) {
    ++counts.nonFinite;
    return;
  }
  addTo(pixel, PixelSums::kDirect, r.direct);
  addTo(pixel, PixelSums::kIndirect, r.indirect);
  addTo(pixel, PixelSums::kClamped, r.clamped);
  addTo(pixel, PixelSums::kCompensated, r.compensated);
  addTo(pixel, PixelSums::kAlbedo, r.albedo);
  addTo(pixel, PixelSums::kNormal, r.normal);
  pixel.sum[PixelSums::kDepth] += double{r.depth};
  if (r.depth > 0.0f) pixel.sum[PixelSums::kHits] += 1.0;
  counts.cut += r.cut;
  counts.shadowRays += r.shadowRays;
}

// What is done, for a checkpoint: passes and the tiles of one, then photons; the sums of all
// pixels.
struct Progress {
  uint64_t pass = 0;
  SplatProgress splats;
};
std::string encode(const Progress& progress, const std::vector<uint8_t>& done,
                   const std::vector<PixelSums>& pixels, const std::vector<PixelCounts>& counts) {
  std::string bytes;
  appendArray(bytes, std::array{progress});
  appendArray(bytes, done);
  appendArray(bytes, pixels);
  appendArray(bytes, counts);
  return bytes;
}

Progress decode(std::string_view bytes, std::vector<uint8_t>& done, std::vector<PixelSums>& pixels,
                std::vector<PixelCounts>& counts) {
  std::array<Progress, 1> progress{};
  takeArray(bytes, progress);
  takeArray(bytes, done);
  takeArray(bytes, pixels);
  takeArray(bytes, counts);
  requireAllTaken(bytes);
  return progress[0];
}

// The pixels of one tile, row by row.
struct Tile {
  uint32_t x0, y0, x1, y1;
  uint32_t pixels() const { return (x1 - x0) * (y1 - y0); }
  uint32_t x(uint32_t p) const { return x0 + p % (x1 - x0); }
  uint32_t y(uint32_t p) const { return y0 + p / (x1 - x0); }
};

CameraSample makeSample(const Scene& scene, uint64_t key, uint32_t spp, uint32_t x, uint32_t y,
                        uint32_t slot) {
  const uint64_t index = uint64_t{y} * scene.film.width + x;
  const Point2 jitter = r2Sequence(slot, double{toUnitFloat(random64(key, index, 0))},
                                   double{toUnitFloat(random64(key, index, 1))});
  CameraSample s;
  s.origin = scene.camera.position;
  s.direction =
      cameraDirection(scene.camera, scene.film, (float(x) + jitter.x) / float(scene.film.width),
                      (float(y) + jitter.y) / float(scene.film.height));
  s.rng = Rng(key + 1, index * spp + slot);
  return s;
}

void renderTile(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                uint64_t key, const Tile& tile, uint32_t firstSlot, uint32_t endSlot,
                std::vector<PixelSums>& pixels, std::vector<PixelCounts>& counts) {
  const uint64_t tileKey = mix64(key + 2 + (uint64_t{tile.y0} << 32 | tile.x0));
  std::vector<CameraSample> samples;
  for (uint32_t slot = firstSlot, slotEnd; slot < endSlot; slot = slotEnd) {
    slotEnd =
        slot + std::min(endSlot - slot,
                        integrator.wholePixels ? UINT32_MAX : kSlotsAtOnce);  // no sum beyond 2^32
    samples.clear();
    for (uint32_t s = slot; s < slotEnd; ++s) {
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        samples.push_back(makeSample(scene, key, options.spp, tile.x(p), tile.y(p), s));
      }
    }
    integrator.samples(
        {{tile.pixels(), tile.x1 - tile.x0, tile.x0, tile.y0, slot, options.spp, tileKey},
         samples});
    for (size_t k = 0; k < samples.size(); ++k) {
      const auto p = static_cast<uint32_t>(k % tile.pixels());
      const size_t i = size_t{tile.y(p)} * scene.film.width + tile.x(p);
      addSample(samples[k].radiance, pixels[i], counts[i]);
    }
  }
}

void addChannels(const Layer& layer, const std::vector<PixelSums>& pixels,
                 const std::vector<PixelCounts>& counts, double perSample, Image& image) {
  for (size_t c = 0; c < std::max<size_t>(1, layer.channels.size()); ++c) {
    std::vector<float>& data = image.add(channelName(layer, c));
    for (size_t i = 0; i < data.size(); ++i) {
      data[i] = static_cast<float>(layer.value({pixels[i], counts[i], perSample}, c));
    }
  }
}

// What the image shows.
void addImage(const std::vector<PixelSums>& pixels, double perSample, Only only, Image& image) {
  const bool direct = only != Only::Indirect, indirect = only != Only::Direct;
  for (size_t c = 0; c < 3; ++c) {
    std::vector<float>& data = image.add(std::string(1, "RGB"[c]));
    for (size_t i = 0; i < data.size(); ++i) {
      const auto& sum = pixels[i].sum;
      data[i] = static_cast<float>(((direct ? sum[PixelSums::kDirect + c] : 0.0) +
                                    (indirect ? sum[PixelSums::kIndirect + c] : 0.0)) *
                                   perSample);
    }
  }
}

}  // namespace

Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress, const Resume& resume) {
  const uint32_t width = scene.film.width, height = scene.film.height;
  const uint64_t key = streamKey(options.seed, Stream::PixelSamples);
  Image image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  std::vector<PixelSums> pixels(image.pixelCount());
  std::vector<PixelCounts> counts(image.pixelCount());

  const size_t tilesX = (width + kTileSide - 1) / kTileSide,
               tilesY = (height + kTileSide - 1) / kTileSide;
  const auto tileOf = [&](size_t index) {
    const auto x0 = static_cast<uint32_t>(index % tilesX) * kTileSide,
               y0 = static_cast<uint32_t>(index / tilesX) * kTileSide;
    return Tile{x0, y0, std::min(width, x0 + kTileSide), std::min(height, y0 + kTileSide)};
  };
  std::vector<uint8_t> done(tilesX * tilesY);
  Progress at;
  if (!resume.state.empty()) at = decode(resume.state, done, pixels, counts);
  const uint64_t perPass = integrator.wholePixels ? options.spp : kSlotsPerPass;
  const uint64_t passes = (options.spp + perPass - 1) / perPass;
  const auto slotsBefore = [&](uint64_t p) {
    return static_cast<uint32_t>(std::min<uint64_t>(options.spp, p * perPass));
  };
  const auto state = [&] { return encode(at, done, pixels, counts); };
  if (progress) progress(image.pixelCount() * slotsBefore(at.pass) + at.splats.photons);
  for (; at.pass < passes; ++at.pass, std::fill(done.begin(), done.end(), 0)) {
    const uint32_t begin = slotsBefore(at.pass), end = slotsBefore(at.pass + 1);
    const auto report = [&](const Tile& tile) {
      if (progress) progress(uint64_t{tile.pixels()} * (end - begin));
    };
    for (size_t index = 0; index < done.size(); ++index) {
      if (done[index]) report(tileOf(index));
    }
    forUnitsLeft(
        done, resume,
        [&](size_t index) {
          const Tile tile = tileOf(index);
          renderTile(scene, integrator, options, key, tile, begin, end, pixels, counts);
          report(tile);
        },
        state);
  }
  if (integrator.photons) {
    addSplats(
        integrator.photons, uint64_t{options.spp} * image.pixelCount(), at.splats,
        [&](const Splat& splat) {
          if (!isFinite(splat.radiance)) {
            ++counts[splat.pixel].nonFinite;
            return;
          }
          addTo(pixels[splat.pixel], PixelSums::kIndirect, splat.radiance);
        },
        progress, resume, state);
  }

  const double perSample = 1.0 / options.spp;
  addImage(pixels, perSample, options.only, image);
  for (const Layer* layer : options.layers) addChannels(*layer, pixels, counts, perSample, image);

  const auto meanOf = [&](size_t slot) {
    return parallelSum(
               pixels.size(),
               [&](size_t i) {
                 return (pixels[i].sum[slot] + pixels[i].sum[slot + 1] + pixels[i].sum[slot + 2]) /
                        3.0;
               }) *
           perSample / static_cast<double>(pixels.size());
  };
  stats.direct = meanOf(PixelSums::kDirect);
  stats.indirect = meanOf(PixelSums::kIndirect);
  stats.clamped = meanOf(PixelSums::kClamped);
  stats.compensated = meanOf(PixelSums::kCompensated);
  stats.samples = uint64_t{options.spp} * pixels.size();
  stats.nonFinite = at.splats.nonFinite;
  for (const PixelCounts& c : counts) {
    stats.cut += double(c.cut);
    stats.shadowRays += double(c.shadowRays);
    stats.nonFinite += c.nonFinite;
  }
  stats.cut /= double(stats.samples);
  stats.shadowRays /= double(stats.samples);
  return image;
}

}  // namespace bnvpl
