#include "tools/render/film/film.h"

#include <algorithm>
#include <array>

#include "core/random_streams.h"
#include "tools/render/film/film_state.h"
#include "tools/render/film/film_sums.h"
#include "tools/render/film/fireflies.h"

namespace bnvpl {

namespace {

// Samples per pixel in each round over the film. Work can be interrupted between the tiles of a
// round.
constexpr uint32_t kSamplesPerRound = 64;

constexpr std::string_view kFirstHitWork = "first hits";

// The rows of a crop, one after the other. `perPixel`: values of each pixel.
template <typename T>
std::vector<T> cropped(const std::vector<T>& film, uint32_t width, const PixelBox& box,
                       size_t perPixel = 1) {
  const auto times = static_cast<std::ptrdiff_t>(perPixel);
  std::vector<T> out;
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = film.begin() + static_cast<std::ptrdiff_t>(y) * width * times;
    out.insert(out.end(), row + box.x0 * times, row + box.x1 * times);
  }
  return out;
}

// The image of a crop on the film, with zeros around it.
Image onFilm(const Image& crop, const Film& film, const PixelBox& box) {
  Image image = blankImage(film);
  if (box != PixelBox{0, 0, image.width, image.height}) image.dataWindow = box;
  for (const ImageChannel& channel : crop.channels) {
    std::vector<float>& data = image.add(channel.name);
    for (int y = box.y0; y < box.y1; ++y)
      std::copy_n(channel.data.begin() + static_cast<std::ptrdiff_t>(y - box.y0) * crop.width,
                  crop.width, data.begin() + static_cast<std::ptrdiff_t>(y) * image.width + box.x0);
  }
  return image;
}

// Traces the layers of first hits of a shard's tiles.
void giveFirstHits(const FilmState& state, const FirstHitValues& values, const ShardSink& sink) {
  if (!values) return;
  std::vector<std::vector<float>> tiles(state.tiles.count());
  parallelFor(tiles.size(), 1, [&](size_t t) {
    if (state.shard.has(t) && state.tiles.meets(t, state.crop)) tiles[t] = values(t);
  });
  for (size_t t = 0; t < tiles.size(); ++t)
    if (!tiles[t].empty()) giveRecord(sink, kFirstHitWork, t, tiles[t]);
}

std::vector<std::vector<float>> takeFirstHits(const FilmState& state, size_t channels,
                                              const ShardSource& source) {
  std::vector<std::vector<float>> tiles(state.tiles.count());
  for (size_t t = 0; t < tiles.size(); ++t) {
    if (channels == 0 || !state.tiles.meets(t, state.crop)) continue;
    tiles[t].resize(channels * state.tiles.at(t).pixels());
    takeRecord(source, kFirstHitWork, t, tiles[t]);
  }
  return tiles;
}

// `firstHits`: values of the layers of first hits.
Image develop(const Film& size, const FilmOptions& options, FilmState& state, FilmStats& stats,
              const FirstHitValues& firstHits) {
  if (state.splats.pixels() > 0) {
    for (size_t i = 0; i < state.pixels.size(); ++i) {
      for (size_t c = 0; c < 3; ++c)
        state.pixels[i].sum[PixelSums::kIndirect + c] += state.splats.sum(i, c);
    }
  }
  const PixelBox box = options.crop.value_or(
      PixelBox{0, 0, static_cast<int>(size.width), static_cast<int>(size.height)});
  if (options.gatherFilter)
    applyFilter(
        options.gatherFilter, size.width, box, [&](size_t) { return options.spp; }, state.pixels,
        state.counts);
  for (size_t k = 0; options.only != Only::Direct && k < state.groupSplats.pixels(); ++k) {
    for (size_t c = 0; c < 3; ++c) state.groups.sums[3 * k + c] += state.groupSplats.sum(k, c);
  }
  Film shown = size;
  if (options.crop) {
    state.pixels = cropped(state.pixels, size.width, box);
    state.counts = cropped(state.counts, size.width, box);
    state.groups.forArrays([&](auto, auto& array, size_t perPixel) {
      array = cropped(array, size.width, box, perPixel);
    });
    shown.width = static_cast<uint32_t>(box.x1 - box.x0);
    shown.height = static_cast<uint32_t>(box.y1 - box.y0);
  }
  Image image = blankImage(shown);
  FilmSums film{state.pixels, state.counts, 1.0 / options.spp, {}, {}, &state.groups};
  std::vector<Vec3> groupsRedistributed;
  std::vector<BothLights> redistributed;
  if (options.redistributeFireflies)
    film.redistributed = redistributed =
        redistributeFireflies(film, options.only, shown.width, &groupsRedistributed);
  addRadiance(film, options.only, image);
  addGroups(state.groups, options.groups, film.perSample, groupsRedistributed, image);
  for (const Layer* layer : options.layers) addLayer(*layer, film, image);
  addFirstHits(state.tiles, options.layers, firstHits, box, image);
  stats = statsOf(film, uint64_t{options.spp} * state.pixels.size());
  stats.nonFinite += state.splats.nonFinite();
  return options.crop ? onFilm(image, size, *options.crop) : image;
}

// Shows the pixels of a tile that have `samples` samples.
void showTile(const FilmState& film, const Tile& tile, uint32_t samples, Only only,
              const FilmPreview& preview) {
  if (preview.tile)
    preview.tile(boxOf(tile), meanRadiance(film.tiles, tile, film.pixels, only, samples));
}

// Shows the film after the share `done` of the photons. Samples are complete.
void showPhotons(const Film& size, const FilmState& film, const FilmOptions& options, double done,
                 const FilmPreview& preview) {
  std::vector<Vec3> radiance(film.pixels.size());
  for (size_t i = 0; i < radiance.size(); ++i) {
    radiance[i] = meanRadiance(film.pixels[i], options.only, options.spp);
    if (options.only == Only::Direct) continue;
    for (size_t c = 0; c < 3; ++c)
      radiance[i][c] += static_cast<float>(film.splats.sum(i, c) / (done * options.spp));
  }
  preview.image(imageOf(radiance, size));
}

// Adds the light of all photons of the image, one for each camera sample, to the film.
void addPhotons(const Film& size, const Splatter& splat, const FilmOptions& options,
                FilmState& film, const ProgressFn& progress, const WorkControls& controls,
                const FilmPreview& preview) {
  const uint64_t photons = uint64_t{options.spp} * film.pixels.size();
  const auto phase = progress.beginPhase("photons", controls.shard.shareOf(photons));
  if (progress) progress(film.at.splats.traced);
  addSplats(
      splat, photons, film.at.splats, [&](const Splat& s) { film.add(s); }, progress, controls,
      [&] { return film.encode(); },
      [&, pace = PreviewPace(nowS() + 1.0)]() mutable {
        if (!preview.image || !pace.due()) return;
        pace.show([&] {
          const double done = double(film.at.splats.traced) / double(photons);
          showPhotons(size, film, options, done, preview);
        });
      });
  film.splats.addNonFinite(film.at.splats.nonFinite);
}

}  // namespace

std::optional<PixelBox> sampledPixels(const Film& film, const FilmOptions& options) {
  if (!options.crop || !options.gatherFilter) return options.crop;
  return options.gatherFilter.needed(*options.crop, film.width, film.height);
}

Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress, const WorkControls& controls,
                 const FilmPreview& preview) {
  const uint64_t key = streamKey(options.seed, RandomStream::PixelSamples);
  FilmState film(scene.film, static_cast<bool>(integrator.splatPhotons), controls.shard,
                 sampledPixels(scene.film, options), options.groups.size());
  const Tiles& tiles = film.tiles;
  if (!controls.state.empty()) film.decode(controls.state);
  const uint64_t perRound = integrator.wholePixels ? options.spp : kSamplesPerRound;
  const uint64_t rounds = (options.spp + perRound - 1) / perRound;
  const auto samplesBefore = [&](uint64_t round) {
    return static_cast<uint32_t>(std::min<uint64_t>(options.spp, round * perRound));
  };
  const auto state = [&] { return film.encode(); };
  const uint64_t own = controls.shard.shareOf(tiles.pixelsMeeting(film.crop));
  // What a checkpoint holds is reported at once, as it says nothing of the speed.
  uint64_t doneBefore = own * samplesBefore(film.at.round);
  for (size_t index = 0; index < film.done.size(); ++index) {
    if (film.done[index] == 1)
      doneBefore += uint64_t{tiles.at(index).pixels()} *
                    (samplesBefore(film.at.round + 1) - samplesBefore(film.at.round));
  }
  if (progress && doneBefore > 0) progress(doneBefore);
  for (; film.at.round < rounds; ++film.at.round, film.beginRound()) {
    const uint32_t begin = samplesBefore(film.at.round), end = samplesBefore(film.at.round + 1);
    const auto report = [&](const Tile& tile) {
      if (progress) progress(uint64_t{tile.pixels()} * (end - begin));
    };
    forUnitsLeft(
        film.done, controls,
        [&](size_t index) {
          const Tile tile = tiles.at(index);
          sampleTile(scene, options.filter, integrator, key, tile,
                     {begin, end, options.spp, options.spp}, film.groups.count,
                     [&](uint32_t p, const CameraSample& sample) {
                       const size_t i = tiles.pixelIndex(tile, p);
                       if (addSample(sample.radiance, film.pixels[i], film.counts[i]))
                         film.groups.add(i, sample, options.only, 1.0f);
                     });
          showTile(film, tile, end, options.only, preview);
          report(tile);
        },
        state);
  }
  if (integrator.splatPhotons)
    addPhotons(scene.film, integrator.splatPhotons, options, film, progress, controls, preview);
  if (!controls.sink) return develop(scene.film, options, film, stats, options.firstHits);
  film.giveTo(*controls.sink);
  giveFirstHits(film, options.firstHits, *controls.sink);
  return blankImage(scene.film);
}

Image joinFilm(const Film& film, const FilmOptions& options, bool photons, FilmStats& stats,
               const ShardSource& source) {
  FilmState state(film, photons, {}, sampledPixels(film, options), options.groups.size());
  state.takeFrom(source);
  const auto firstHits = takeFirstHits(state, firstHitChannels(options.layers), source);
  return develop(film, options, state, stats, [&](size_t tile) { return firstHits[tile]; });
}

}  // namespace bnvpl
