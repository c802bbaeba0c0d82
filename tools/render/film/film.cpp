#include "tools/render/film/film.h"

#include <array>

#include "tools/common/files/streams.h"
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

constexpr std::string_view kTileWork = "tiles", kPhotonWork = "photons";

// Sums of the samples and photons so far, and for a checkpoint how far they are: rounds, the tiles
// of one, then photons.
struct FilmState {
  struct Progress {
    uint64_t round = 0;
    SplatProgress splats;
  };
  FilmState(const Film& film, bool photons, const Shard& of)
      : tiles(film),
        pixels(size_t{film.width} * film.height),
        counts(pixels.size()),
        splats(photons ? pixels.size() : 0),
        shard(of) {
    beginRound();
  }
  void beginRound() { done = unitsToDo(tiles.count(), shard); }

  std::string encode() const {
    std::string bytes;
    appendArray(bytes, std::array{at});
    appendArray(bytes, done);
    appendArray(bytes, pixels);
    appendArray(bytes, counts);
    appendArray(bytes, splats.integers());
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
    requireAllTaken(bytes);
    at = progress[0];
    splats.setIntegers(integers);
  }

  void giveTo(const ShardSink& sink) const {
    std::vector<TilePixel> record;
    for (size_t t = 0; t < tiles.count(); ++t) {
      if (!shard.has(t)) continue;
      const Tile tile = tiles.at(t);
      record.resize(tile.pixels());
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        const size_t i = tiles.pixelIndex(tile, p);
        record[p] = {pixels[i], counts[i]};
      }
      giveRecord(sink, kTileWork, t, record);
    }
    if (splats.pixels() > 0) sink.sums(kPhotonWork, splats.integers());
  }
  void takeFrom(const ShardSource& source) {
    std::vector<TilePixel> record;
    for (size_t t = 0; t < tiles.count(); ++t) {
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
  Shard shard;
};

Image blankImage(const Film& film) {
  Image image;
  image.width = static_cast<int>(film.width);
  image.height = static_cast<int>(film.height);
  return image;
}

Image develop(const Film& size, const FilmOptions& options, FilmState& state, FilmStats& stats) {
  Image image = blankImage(size);
  if (state.splats.pixels() > 0) {
    for (size_t i = 0; i < state.pixels.size(); ++i) {
      for (size_t c = 0; c < 3; ++c)
        state.pixels[i].sum[PixelSums::kIndirect + c] += state.splats.sum(i, c);
    }
  }
  FilmSums film{state.pixels, state.counts, 1.0 / options.spp};
  std::vector<BothLights> redistributed;
  if (options.redistributeFireflies)
    film.redistributed = redistributed = redistributeFireflies(film, options.only, size.width);
  addRadiance(film, options.only, image);
  for (const Layer* layer : options.layers) addLayer(*layer, film, image);
  stats = statsOf(film, uint64_t{options.spp} * state.pixels.size());
  stats.nonFinite += state.splats.nonFinite();
  return image;
}

}  // namespace

Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress, const Resume& resume) {
  const uint64_t key = streamKey(options.seed, Stream::PixelSamples);
  FilmState film(scene.film, static_cast<bool>(integrator.tracePhotons), resume.shard);
  const Tiles& tiles = film.tiles;
  if (!resume.state.empty()) film.decode(resume.state);
  const uint64_t perRound = integrator.wholePixels ? options.spp : kSamplesPerRound;
  const uint64_t rounds = (options.spp + perRound - 1) / perRound;
  const auto samplesBefore = [&](uint64_t round) {
    return static_cast<uint32_t>(std::min<uint64_t>(options.spp, round * perRound));
  };
  const auto state = [&] { return film.encode(); };
  const uint64_t own = resume.shard.shareOf(film.pixels.size());
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
                     {begin, end, options.spp, options.spp},
                     [&](uint32_t p, const RadianceSample& sample) {
                       const size_t i = tiles.pixelIndex(tile, p);
                       addSample(sample, film.pixels[i], film.counts[i]);
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
        [&](const Splat& splat) { film.splats.add(splat); }, progress, resume, state);
    film.splats.addNonFinite(film.at.splats.nonFinite);
  }
  if (!resume.sink) return develop(scene.film, options, film, stats);
  film.giveTo(*resume.sink);
  return blankImage(scene.film);
}

Image joinFilm(const Film& film, const FilmOptions& options, bool photons, FilmStats& stats,
               const ShardSource& source) {
  FilmState state(film, photons, {});
  state.takeFrom(source);
  return develop(film, options, state, stats);
}

}  // namespace bnvpl
