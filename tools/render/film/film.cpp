#include "tools/render/film/film.h"

#include <array>

#include "tools/common/streams.h"
#include "tools/render/film/develop.h"
#include "tools/render/film/samples.h"
#include "tools/render/film/splats.h"

namespace bnvpl {

namespace {

constexpr uint32_t kSlotsPerPass = 64;  // over the whole image; work stops between tiles of a pass

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

}  // namespace

Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress, const Resume& resume) {
  const uint64_t key = streamKey(options.seed, Stream::PixelSamples);
  Image image;
  image.width = static_cast<int>(scene.film.width);
  image.height = static_cast<int>(scene.film.height);
  std::vector<PixelSums> pixels(image.pixelCount());
  std::vector<PixelCounts> counts(image.pixelCount());

  const Tiles tiles(scene.film);
  std::vector<uint8_t> done(tiles.count());
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
      if (done[index]) report(tiles.at(index));
    }
    forUnitsLeft(
        done, resume,
        [&](size_t index) {
          const Tile tile = tiles.at(index);
          sampleTile(scene, integrator, key, tile, {begin, end, options.spp, options.spp},
                     [&](uint32_t p, const RadianceSample& sample) {
                       const size_t i = tiles.pixelIndex(tile, p);
                       addSample(sample, pixels[i], counts[i]);
                     });
          report(tile);
        },
        state);
  }
  if (integrator.photons) {
    addSplats(
        integrator.photons, uint64_t{options.spp} * image.pixelCount(), at.splats,
        [&](const Splat& splat) { addSplat(splat, 1.0f, pixels, counts); }, progress, resume,
        state);
  }

  const Exposed film{pixels, counts, 1.0 / options.spp};
  addShown(film, options.only, image);
  for (const Layer* layer : options.layers) addLayer(*layer, film, image);
  stats = statsOf(film, uint64_t{options.spp} * pixels.size());
  stats.nonFinite += at.splats.nonFinite;
  return image;
}

}  // namespace bnvpl
