// What a film knows while it is rendered.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/work_controls.h"
#include "tools/render/film/film_groups.h"
#include "tools/render/film/splat_sums.h"
#include "tools/render/film/tiles.h"
#include "tools/render/splat/add_splats.h"

namespace bnvpl {

// Records of a shard.
inline constexpr std::string_view kTileWork = "tiles", kPhotonWork = "photons",
                                  kGroupPhotonWork = "group.splats";

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
      groupSplats.add(size_t{splat.pixel} * groups.count + splat.group, splat.radiance);
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
    forOwnTiles([&](size_t t, const Tile& tile) {
      record.resize(tile.pixels());
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        const size_t i = tiles.pixelIndex(tile, p);
        record[p] = {pixels[i], counts[i]};
      }
      giveRecord(sink, kTileWork, t, record);
    });
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

}  // namespace bnvpl
