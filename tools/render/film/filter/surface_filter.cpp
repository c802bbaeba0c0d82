#include "tools/render/film/filter/surface_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace bnvpl {

namespace {

constexpr std::array<float, 5> kTaps{1 / 16.0f, 4 / 16.0f, 6 / 16.0f, 4 / 16.0f, 1 / 16.0f};
constexpr ptrdiff_t kReach = 2;  // taps on each side

// Differences at which a weight is 0.
constexpr float kMaxTurn = 0.5f;      // squared distance of two unit normals: 41 degrees
constexpr float kMaxAlbedo = 0.5f;    // share of the larger albedo plus kDarkAlbedo
constexpr float kDarkAlbedo = 0.05f;  // albedo whose differences are invisible
constexpr float kMaxDepth = 0.05f;    // share of the inverse depth, off the other pixel's plane
constexpr float kMaxSlope = 0.25f;    // added share of the change that the plane's slope explains

// 1 for no difference, 0 from the maximum on.
float falloff(float difference, float maximum) {
  const float x = difference / maximum;
  const float rest = std::max(0.0f, 1.0f - x * x);
  return rest * rest;
}

// The slope of smaller magnitude, which ignores an edge on one side.
float lesser(float a, float b) { return std::abs(a) < std::abs(b) ? a : b; }

}  // namespace

SurfaceFilter::SurfaceFilter(std::span<const PixelSums> sums, size_t width, Edges edges)
    : width_(width), height_(sums.size() / width), edges_(edges), surfaces_(sums.size()) {
  parallelFor(sums.size(), 1024, [&](size_t i) {
    const auto& sum = sums[i].sum;
    const double hits = sum[PixelSums::kHits];
    if (!(hits > 0.0)) return;
    const auto mean = [&](size_t channel) {
      return Vec3(float(sum[channel] / hits), float(sum[channel + 1] / hits),
                  float(sum[channel + 2] / hits));
    };
    Surface& s = surfaces_[i];
    const Vec3 normal = mean(PixelSums::kNormal);
    if (length(normal) > 0.0f) s.normal = normalize(normal);
    s.albedo = mean(PixelSums::kAlbedo);
    s.inverseDepth = static_cast<float>(hits / sum[PixelSums::kDepth]);
  });
  findSlopes();
}

// The inverse depth of a plane is a linear function on the film.
void SurfaceFilter::findSlopes() {
  parallelFor(surfaces_.size(), 1024, [&](size_t i) {
    Surface& s = surfaces_[i];
    const std::array<size_t, 2> at{i % width_, i / width_}, count{width_, height_},
        stride{1, width_};
    for (const size_t axis : {kX, kY}) {
      const float before =
          at[axis] > 0 ? s.inverseDepth - surfaces_[i - stride[axis]].inverseDepth : INFINITY;
      const float after = at[axis] + 1 < count[axis]
                              ? surfaces_[i + stride[axis]].inverseDepth - s.inverseDepth
                              : INFINITY;
      const float slope = lesser(before, after);
      s.slope[axis] = std::isfinite(slope) ? slope : 0.0f;
    }
  });
}

float SurfaceFilter::weight(size_t i, size_t j, Axis axis, float pixelsApart) const {
  const Surface &a = surfaces_[i], &b = surfaces_[j];
  if (a.inverseDepth == 0.0f || b.inverseDepth == 0.0f) return 0.0f;
  if (edges_ == Edges::Ignore) return 1.0f;
  const float turn = falloff(lengthSquared(a.normal - b.normal), kMaxTurn);
  if (!(turn > 0.0f)) return 0.0f;
  const float change = b.inverseDepth - a.inverseDepth, byA = a.slope[axis] * pixelsApart,
              byB = b.slope[axis] * pixelsApart;
  const float off = std::min(std::abs(change - byA), std::abs(change - byB));
  const float bent = falloff(off, kMaxDepth * std::max(a.inverseDepth, b.inverseDepth) +
                                      kMaxSlope * std::max(std::abs(byA), std::abs(byB)));
  if (!(bent > 0.0f)) return 0.0f;
  const Vec3 larger = max(a.albedo, b.albedo), apart = larger - min(a.albedo, b.albedo);
  return turn * bent *
         falloff(maxComponent(apart), kMaxAlbedo * (maxComponent(larger) + kDarkAlbedo));
}

FilmValues SurfaceFilter::along(const FilmValues& values, Axis axis, size_t level) const {
  FilmValues out(values.size());
  const auto step = static_cast<ptrdiff_t>(size_t{1} << level);
  const size_t stride = axis == kX ? 1 : width_, count = axis == kX ? width_ : height_;
  parallelFor(height_, 4, [&](size_t y) {
    for (size_t x = 0; x < width_; ++x) {
      const size_t i = y * width_ + x;
      const auto at = static_cast<ptrdiff_t>(axis == kX ? x : y);
      float sum = kTaps[kReach] * values[i];
      for (ptrdiff_t k = -kReach; k <= kReach; ++k) {
        const ptrdiff_t to = at + k * step;
        if (k == 0 || to < 0 || to >= static_cast<ptrdiff_t>(count)) continue;
        const size_t j = i + static_cast<size_t>(k * step) * stride;
        if (values[j] == 0.0f) continue;
        sum +=
            kTaps[static_cast<size_t>(k + kReach)] *
            weight(std::min(i, j), std::max(i, j), axis, static_cast<float>(std::abs(k * step))) *
            values[j];
      }
      out[i] = sum;
    }
  });
  return out;
}

FilmValues SurfaceFilter::smooth(const FilmValues& values, size_t level) const {
  return along(along(values, kX, level), kY, level);
}

FilmValues SurfaceFilter::scatter(const FilmValues& values, size_t level) const {
  return along(along(values, kY, level), kX, level);
}

size_t SurfaceFilter::levels() const {
  size_t levels = 1;
  while ((size_t{2} << levels) < std::max(width_, height_)) ++levels;
  return levels;
}

// Along one axis the kernel is the fourth convolution power of a box of m = 2^(level + 1) pixels.
double SurfaceFilter::peak(size_t level) {
  const double m = std::exp2(double(level) + 1.0),
               alongOne = (2.0 * m * m + 1.0) / (3.0 * m * m * m);
  return alongOne * alongOne;
}

}  // namespace bnvpl
