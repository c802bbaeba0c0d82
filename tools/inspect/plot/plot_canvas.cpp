#include "tools/inspect/plot/plot_canvas.h"

#include <algorithm>

namespace bnvpl {
namespace {

constexpr Vec3 kRim{0.05f, 0.05f, 0.08f};
// Fraction of the radius. A thinner rim cannot be seen on bright surfaces at the usual 5 pixels.
constexpr float kRimShare = 0.3f;

// Fraction of a pixel that a disk covers, by the distance of their centres. It is exact for a
// straight edge parallel to the pixel's side, and close for disks of a few pixels.
float coverage(float distance, float radius) {
  return std::clamp(radius + 0.5f - distance, 0.0f, 1.0f);
}

void paintDot(Canvas& canvas, const Dot& dot, float radius) {
  const float inner = radius * (1.0f - kRimShare);
  const int left = std::max(0, static_cast<int>(std::floor(dot.x - radius - 1.0f)));
  const int right = std::min(canvas.width - 1, static_cast<int>(std::ceil(dot.x + radius + 1.0f)));
  const int top = std::max(0, static_cast<int>(std::floor(dot.y - radius - 1.0f)));
  const int bottom =
      std::min(canvas.height - 1, static_cast<int>(std::ceil(dot.y + radius + 1.0f)));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const float dx = static_cast<float>(x) + 0.5f - dot.x,
                  dy = static_cast<float>(y) + 0.5f - dot.y;
      const float distance = std::sqrt(dx * dx + dy * dy);
      const float disk = coverage(distance, radius), fill = coverage(distance, inner);
      Vec3& pixel = canvas.pixels[static_cast<size_t>(y) * static_cast<size_t>(canvas.width) +
                                  static_cast<size_t>(x)];
      if (dot.hollow) {
        pixel += (dot.colour - pixel) * (0.7f * (disk - fill));
      } else {
        pixel += (kRim - pixel) * disk;
        pixel += (dot.colour - pixel) * fill;
      }
    }
  }
}

}  // namespace

void Canvas::paint(std::vector<Dot> dots, float diameter) {
  std::stable_sort(dots.begin(), dots.end(),
                   [](const Dot& a, const Dot& b) { return a.depth > b.depth; });
  for (const Dot& dot : dots) paintDot(*this, dot, 0.5f * diameter);
}

std::vector<uint8_t> Canvas::rgb8() const {
  std::vector<uint8_t> bytes;
  bytes.reserve(3 * pixels.size());
  for (const Vec3& p : pixels) {
    for (size_t k = 0; k < 3; ++k) {
      bytes.push_back(static_cast<uint8_t>(std::lround(std::clamp(p[k], 0.0f, 1.0f) * 255.0f)));
    }
  }
  return bytes;
}

}  // namespace bnvpl
