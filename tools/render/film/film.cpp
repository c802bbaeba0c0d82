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
std::vector<T> cropped(const std::vector<T>& values, uint32_t width, const PixelBox& box,
                       size_t perPixel = 1) {
  const auto times = static_cast<std::ptrdiff_t>(perPixel);
  std::vector<T> out;
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(y) * width * times;
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

// Adds the light of photons to the indirect light of their pixels.
void addSplatsTo(FilmState& state) {
  if (state.splats.pixels() == 0) return;
  for (size_t i = 0; i < state.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c)
      state.pixels[i].sum[PixelSums::kIndirect + c] += state.splats.sum(i, c);
  }
}

// The same by light group.
void addGroupSplatsTo(FilmState& state) {
  for (size_t k = 0; k < state.groupSplats.pixels(); ++k) {
    for (size_t c = 0; c < 3; ++c) state.groups.sums[3 * k + c] += state.groupSplats.sum(k, c);
  }
}

// Keeps only the pixels of the box. `width`: that of the film.
void cropTo(const PixelBox& box, uint32_t width, FilmState& state) {
  state.pixels = cropped(state.pixels, width, box);
  state.counts = cropped(state.counts, width, box);
  state.groups.forArrays(
      [&](auto, auto& array, size_t perPixel) { array = cropped(array, width, box, perPixel); });
}

// `firstHits`: values of the layers of first hits.
Image develop(const Film& film, const FilmOptions& options, FilmState& state, FilmStats& stats,
              const FirstHitValues& firstHits) {
  addSplatsTo(state);
  const PixelBox box = options.crop.value_or(
      PixelBox{0, 0, static_cast<int>(film.width), static_cast<int>(film.height)});
  if (options.gatherFilter)
    applyFilter(
        options.gatherFilter, film.width, box, [&](size_t) { return options.spp; }, state.pixels,
        state.counts);
  if (options.shown != ShownLight::Direct) addGroupSplatsTo(state);
  Film visible = film;
  if (options.crop) {
    cropTo(box, film.width, state);
    visible.width = static_cast<uint32_t>(box.x1 - box.x0);
    visible.height = static_cast<uint32_t>(box.y1 - box.y0);
  }
  Image image = blankImage(visible);
  FilmSums sums{state.pixels, state.counts, 1.0 / options.spp, {}, {}, &state.groups};
  std::vector<Vec3> groupsRedistributed;
  std::vector<BothLights> redistributed;
  if (options.redistributeFireflies)
    sums.redistributed = redistributed =
        redistributeFireflies(sums, options.shown, visible.width, &groupsRedistributed);
  addRadiance(sums, options.shown, image);
  addGroups(state.groups, options.groups, sums.perSample, groupsRedistributed, image);
  for (const Layer* layer : options.layers) addLayer(*layer, sums, image);
  addFirstHits(state.tiles, options.layers, firstHits, box, image);
  stats = statsOf(sums, uint64_t{options.spp} * state.pixels.size());
  stats.nonFinite += state.splats.nonFinite();
  return options.crop ? onFilm(image, film, *options.crop) : image;
}

// Shows the pixels of a tile that have `samples` samples.
void showTile(const FilmState& state, const Tile& tile, uint32_t samples, ShownLight shown,
              const FilmPreview& preview) {
  if (preview.tile)
    preview.tile(boxOf(tile), meanRadiance(state.tiles, tile, state.pixels, shown, samples));
}

// Shows the film after the share `done` of the photons. Samples are complete.
void showPhotons(const Film& film, const FilmState& state, const FilmOptions& options, double done,
                 const FilmPreview& preview) {
  std::vector<Vec3> radiance(state.pixels.size());
  for (size_t i = 0; i < radiance.size(); ++i) {
    radiance[i] = meanRadiance(state.pixels[i], options.shown, options.spp);
    if (options.shown == ShownLight::Direct) continue;
    for (size_t c = 0; c < 3; ++c)
      radiance[i][c] += static_cast<float>(state.splats.sum(i, c) / (done * options.spp));
  }
  preview.image(imageOf(radiance, film));
}

// Adds the light of all photons of the image, one for each camera sample, to the state.
void addPhotons(const Film& film, const Splatter& splat, const FilmOptions& options,
                FilmState& state, const ProgressFn& progress, const WorkControls& controls,
                const FilmPreview& preview) {
  const uint64_t photons = uint64_t{options.spp} * state.pixels.size();
  const auto phase = progress.beginPhase("photons", controls.shard.shareOf(photons));
  if (progress) progress(state.at.splats.traced);
  addSplats(
      splat, photons, state.at.splats, [&](const Splat& s) { state.add(s); }, progress, controls,
      [&] { return state.encode(); },
      [&, pace = PreviewPace(nowS() + 1.0)]() mutable {
        if (!preview.image || !pace.due()) return;
        pace.show([&] {
          const double done = double(state.at.splats.traced) / double(photons);
          showPhotons(film, state, options, done, preview);
        });
      });
  state.splats.addNonFinite(state.at.splats.nonFinite);
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
  FilmState state(scene.film, static_cast<bool>(integrator.splatPhotons), controls.shard,
                  sampledPixels(scene.film, options), options.groups.size());
  const Tiles& tiles = state.tiles;
  if (!controls.state.empty()) state.decode(controls.state);
  const uint64_t perRound = integrator.wholePixels ? options.spp : kSamplesPerRound;
  const uint64_t rounds = (options.spp + perRound - 1) / perRound;
  const auto samplesBefore = [&](uint64_t round) {
    return static_cast<uint32_t>(std::min<uint64_t>(options.spp, round * perRound));
  };
  const auto encode = [&] { return state.encode(); };
  const uint64_t own = controls.shard.shareOf(tiles.pixelsMeeting(state.crop));
  // What a checkpoint holds is reported at once, as it says nothing of the speed.
  uint64_t doneBefore = own * samplesBefore(state.at.round);
  for (size_t index = 0; index < state.done.size(); ++index) {
    if (state.done[index] == 1)
      doneBefore += uint64_t{tiles.at(index).pixels()} *
                    (samplesBefore(state.at.round + 1) - samplesBefore(state.at.round));
  }
  if (progress && doneBefore > 0) progress(doneBefore);
  for (; state.at.round < rounds; ++state.at.round, state.beginRound()) {
    const uint32_t begin = samplesBefore(state.at.round), end = samplesBefore(state.at.round + 1);
    const auto report = [&](const Tile& tile) {
      if (progress) progress(uint64_t{tile.pixels()} * (end - begin));
    };
    forUnitsLeft(
        state.done, controls,
        [&](size_t index) {
          const Tile tile = tiles.at(index);
          sampleTile(scene, options.filter, integrator, key, tile,
                     {begin, end, options.spp, options.spp}, state.groups.count,
                     [&](uint32_t p, const CameraSample& sample) {
                       const size_t i = tiles.pixelIndex(tile, p);
                       if (addSample(sample.radiance, state.pixels[i], state.counts[i]))
                         state.groups.add(i, sample, options.shown, 1.0f);
                     });
          showTile(state, tile, end, options.shown, preview);
          report(tile);
        },
        encode);
  }
  if (integrator.splatPhotons)
    addPhotons(scene.film, integrator.splatPhotons, options, state, progress, controls, preview);
  if (!controls.sink) return develop(scene.film, options, state, stats, options.firstHits);
  state.giveTo(*controls.sink);
  giveFirstHits(state, options.firstHits, *controls.sink);
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
