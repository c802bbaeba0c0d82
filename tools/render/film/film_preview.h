// What a film shows of itself while it is rendered.
#pragma once

#include <algorithm>
#include <functional>
#include <span>

#include "core/vec3.h"
#include "formats/image/image.h"
#include "tools/common/process/clock.h"

namespace bnvpl {

// Callbacks that show the film so far; any may be empty. They get what the image would be by now,
// but for fireflies in tiles, which are redistributed over the whole film at the end.
struct FilmPreview {
  // Radiance of the pixels of a tile, row by row, W/(m2 sr). Called from any thread.
  std::function<void(const PixelBox& tile, std::span<const Vec3> radiance)> tile = {};
  // R, G, B of the whole film. Called from one thread at a time.
  std::function<void(const Image&)> image = {};
};

// Spaces whole images so that making and showing them takes at most one per cent of the time.
class PreviewPace {
 public:
  explicit PreviewPace(double firstS) : nextS_(firstS) {}  // by nowS()
  bool due() const { return nowS() >= nextS_; }
  template <typename Show>
  void show(const Show& show) {
    const double startS = nowS();
    show();
    const double endS = nowS();
    nextS_ = endS + std::max(1.0, 99.0 * (endS - startS));
  }

 private:
  double nextS_;
};

}  // namespace bnvpl
