#include "tools/render/film/film.h"

#include <algorithm>
#include <array>

#include "tools/common/files/streams.h"
#include "tools/render/film/film_groups.h"
#include "tools/render/film/film_sums.h"
#include "tools/render/film/fireflies.h"
#include "tools/render/film/splat_sums.h"
#include "tools/render/film/tiles.h"
#include "tools/render/splat/add_splats.h"

namespace bnvpl {

namespace {

// Samples per pixel in each round over the film. Work can be interrupted between the tiles of a
// round.
constexpr uint32_t kSamplesPerRound = 64;

constexpr std::string_view kTileWork = "tiles", kPhotonWork = "photons",
                           kFirstHitWork = "first hits", kGroupPhotonWork = "group.splats";

// Sums of the samples and photons so far, and for a checkpoint how far they are: rounds, the tiles
// of one, then photons.
struct FilmState {
  struct Progress {
    uint64_t round = 0;
    SplatProgress splats;
  };
  FilmState(const Film& film, bool photons, const Shard& of, const std::optional<PixelBox>& box,
            size_t lightGroups)
      : tiles(film),
        pixels(size_t{film.width} * film.height),
        counts(pixels.size()),
        splats(photons ? pixels.size() : 0),
        groups(pixels.size(), static_cast<uint32_t>(lightGroups)),
        groupSplats(splats.pixels() * lightGroups),
        shard(of),
        crop(box) {
    beginRound();
  }
  void add(const Splat& splat) {
    splats.add(splat);
    if (groupSplats.pixels() > 0)
      groupSplats.add({splat.pixel * groups.count + splat.group, splat.radiance, 0});
  }
  void beginRound() {
    done = unitsToDo(tiles.count(), shard);
    for (size_t t = 0; t < done.size(); ++t) {
      if (!tiles.meets(t, crop)) done[t] = kElsewhere;
    }
  }

  std::string encode() {
    std::string bytes;
    appendArray(bytes, std::array{at});
    appendArray(bytes, done);
    appendArray(bytes, pixels);
    appendArray(bytes, counts);
    appendArray(bytes, splats.integers());
    groups.forArrays([&](auto, const auto& array, size_t) { appendArray(bytes, array); });
    appendArray(bytes, groupSplats.integers());
    return bytes;
  }
  void decode(std::string_view bytes) {
    std::array<Progress, 1> progress{};
    takeArray(bytes, progress);
    takeArray(bytes, done);
    takeArray(bytes, pixels);
    takeArray(bytes, counts);
    std::vector<int64_t> integers(SplatSums::integersFor(splats.pixels()));
    takeArray(bytes, integers);
    groups.forArrays([&](auto, auto& array, size_t) { takeArray(bytes, array); });
    std::vector<int64_t> ofGroups(SplatSums::integersFor(groupSplats.pixels()));
    takeArray(bytes, ofGroups);
    requireAllTaken(bytes);
    groupSplats.setIntegers(ofGroups);
    at = progress[0];
    splats.setIntegers(integers);
  }

  void giveTo(const ShardSink& sink) {
    std::vector<TilePixel> record;
    for (size_t t = 0; t < tiles.count(); ++t) {
      if (!shard.has(t) || !tiles.meets(t, crop)) continue;
      const Tile tile = tiles.at(t);
      record.resize(tile.pixels());
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        const size_t i = tiles.pixelIndex(tile, p);
        record[p] = {pixels[i], counts[i]};
      }
      giveRecord(sink, kTileWork, t, record);
    }
    if (splats.pixels() > 0) sink.sums(kPhotonWork, splats.integers());
    if (groupSplats.pixels() > 0) sink.sums(kGroupPhotonWork, groupSplats.integers());
    groups.forArrays([&](std::string_view work, auto& array, size_t perPixel) {
      forOwnTiles([&](size_t t, const Tile& tile) {
        auto part = ofTile(tile, array, perPixel);
        giveRecord(sink, work, t, part);
      });
    });
  }
  void takeFrom(const ShardSource& source) {
    std::vector<TilePixel> record;
    for (size_t t = 0; t < tiles.count(); ++t) {
      if (!tiles.meets(t, crop)) continue;
      const Tile tile = tiles.at(t);
      record.resize(tile.pixels());
      takeRecord(source, kTileWork, t, record);
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        const size_t i = tiles.pixelIndex(tile, p);
        pixels[i] = record[p].sums;
        counts[i] = record[p].counts;
      }
    }
    if (splats.pixels() > 0) {
      splats.setIntegers(source.sums(kPhotonWork, SplatSums::integersFor(splats.pixels())));
    }
    if (groupSplats.pixels() > 0) {
      groupSplats.setIntegers(
          source.sums(kGroupPhotonWork, SplatSums::integersFor(groupSplats.pixels())));
    }
    groups.forArrays([&](std::string_view work, auto& array, size_t perPixel) {
      forOwnTiles([&](size_t t, const Tile& tile) {
        auto part = ofTile(tile, array, perPixel);
        takeRecord(source, work, t, part);
        auto from = part.begin();
        for (uint32_t p = 0; p < tile.pixels(); ++p, from += static_cast<std::ptrdiff_t>(perPixel))
          std::copy_n(
              from, perPixel,
              array.begin() + static_cast<std::ptrdiff_t>(tiles.pixelIndex(tile, p) * perPixel));
      });
    });
  }

  // Calls fn(index, tile) for each tile of the shard that has a pixel of the crop.
  template <typename Fn>
  void forOwnTiles(const Fn& fn) const {
    for (size_t t = 0; t < tiles.count(); ++t)
      if (shard.has(t) && tiles.meets(t, crop)) fn(t, tiles.at(t));
  }
  // A tile's values of an array of the film with `perPixel` values for each pixel.
  template <typename T>
  std::vector<T> ofTile(const Tile& tile, const std::vector<T>& array, size_t perPixel) const {
    std::vector<T> out;
    for (uint32_t p = 0; p < tile.pixels(); ++p) {
      const auto begin =
          array.begin() + static_cast<std::ptrdiff_t>(tiles.pixelIndex(tile, p) * perPixel);
      out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(perPixel));
    }
    return out;
  }

  struct TilePixel {  // without padding, as its bytes are saved
    PixelSums sums;
    PixelCounts counts;
  };
  Tiles tiles;
  Progress at;
  std::vector<uint8_t> done;  // tiles of the current round
  std::vector<PixelSums> pixels;
  std::vector<PixelCounts> counts;
  SplatSums splats;
  FilmGroups groups;
  SplatSums groupSplats;  // photons by light group, those of a pixel one after the other
  Shard shard;
  std::optional<PixelBox> crop;
};

Image blankImage(const Film& film) {
  Image image;
  image.width = static_cast<int>(film.width);
  image.height = static_cast<int>(film.height);
  return image;
}

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
  image.dataWindow = box;
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
  double filterPixels = 0.0;
  if (options.gatherFilter)
    filterPixels = applyFilter(options.gatherFilter, size.width, box, state.pixels);
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
        redistributeFireflies(film, options.only, size.width, &groupsRedistributed);
  addRadiance(film, options.only, image);
  addGroups(state.groups, options.groups, film.perSample, groupsRedistributed, image);
  for (const Layer* layer : options.layers) addLayer(*layer, film, image);
  addFirstHits(state.tiles, options.layers, firstHits, box, image);
  stats = statsOf(film, uint64_t{options.spp} * state.pixels.size());
  stats.nonFinite += state.splats.nonFinite();
  stats.filterPixels = filterPixels;
  return options.crop ? onFilm(image, size, *options.crop) : image;
}

}  // namespace

std::optional<PixelBox> sampledPixels(const Film& film, const FilmOptions& options) {
  if (!options.crop || !options.gatherFilter) return options.crop;
  return options.gatherFilter.needed(*options.crop, film.width, film.height);
}

Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress, const Resume& resume) {
  const uint64_t key = streamKey(options.seed, Stream::PixelSamples);
  FilmState film(scene.film, static_cast<bool>(integrator.tracePhotons), resume.shard,
                 sampledPixels(scene.film, options), options.groups.size());
  const Tiles& tiles = film.tiles;
  if (!resume.state.empty()) film.decode(resume.state);
  const uint64_t perRound = integrator.wholePixels ? options.spp : kSamplesPerRound;
  const uint64_t rounds = (options.spp + perRound - 1) / perRound;
  const auto samplesBefore = [&](uint64_t round) {
    return static_cast<uint32_t>(std::min<uint64_t>(options.spp, round * perRound));
  };
  const auto state = [&] { return film.encode(); };
  const uint64_t own = resume.shard.shareOf(tiles.pixelsMeeting(film.crop));
  if (progress) progress(own * samplesBefore(film.at.round));
  for (; film.at.round < rounds; ++film.at.round, film.beginRound()) {
    const uint32_t begin = samplesBefore(film.at.round), end = samplesBefore(film.at.round + 1);
    const auto report = [&](const Tile& tile) {
      if (progress) progress(uint64_t{tile.pixels()} * (end - begin));
    };
    for (size_t index = 0; index < film.done.size(); ++index) {
      if (film.done[index] == 1) report(tiles.at(index));
    }
    forUnitsLeft(
        film.done, resume,
        [&](size_t index) {
          const Tile tile = tiles.at(index);
          sampleTile(scene, options.filter, integrator, key, tile,
                     {begin, end, options.spp, options.spp}, film.groups.count,
                     [&](uint32_t p, const CameraSample& sample) {
                       const size_t i = tiles.pixelIndex(tile, p);
                       if (addSample(sample.radiance, film.pixels[i], film.counts[i]))
                         film.groups.add(i, sample, options.only, 1.0f);
                     });
          report(tile);
        },
        state);
  }
  if (integrator.tracePhotons) {
    const uint64_t photons = uint64_t{options.spp} * film.pixels.size();
    const auto phase = progress.before("photons", resume.shard.shareOf(photons));
    if (progress) progress(film.at.splats.traced);
    addSplats(
        integrator.tracePhotons, photons, film.at.splats,
        [&](const Splat& splat) { film.add(splat); }, progress, resume, state);
    film.splats.addNonFinite(film.at.splats.nonFinite);
  }
  if (!resume.sink) return develop(scene.film, options, film, stats, options.firstHits);
  film.giveTo(*resume.sink);
  giveFirstHits(film, options.firstHits, *resume.sink);
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
