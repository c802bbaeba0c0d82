// A first picture of a film that has only some of its tiles.
#pragma once

#include <mutex>
#include <span>
#include <vector>

#include "formats/image/image.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {

class PartialFilm {
 public:
  explicit PartialFilm(const Film& film);
  // Adds the radiance of a tile's pixels, row by row. From any thread.
  void add(size_t index, std::span<const Vec3> radiance);
  // R, G, B of the film, at least one of whose tiles is there. A tile that is not has the mean
  // radiance of one of the tiles that are nearest to it.
  Image image() const;

 private:
  Tiles tiles_;
  Film film_;
  mutable std::mutex mutex_;
  std::vector<uint8_t> there_;
  std::vector<Vec3> radiance_;
};

// Order of n tiles in which any first part of them is spread over the film: multiples of a stride
// near the golden section of n, which has no factor in common with n.
class SpreadOrder {
 public:
  explicit SpreadOrder(size_t n);
  size_t operator()(size_t i) const { return i * stride_ % n_; }

 private:
  size_t n_, stride_;
};

}  // namespace bnvpl
