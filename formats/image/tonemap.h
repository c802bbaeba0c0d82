// Converts linear light to 8-bit sRGB at a given exposure, without a tone curve, so that previews
// are comparable.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bnvpl {

// IEC 61966-2-1 encoding of a linear value; clamps to 0..1. NaN gives 0.
inline float encodeSrgb(float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  if (linear >= 1.0f) return 1.0f;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

// 8-bit sRGB of linear * 2^exposureEv.
inline uint8_t toSrgb8(float linear, float exposureEv = 0.0f) {
  return static_cast<uint8_t>(std::lround(encodeSrgb(linear * std::exp2(exposureEv)) * 255.0f));
}

// Interleaves three channels of equal length for writePng.
inline std::vector<uint8_t> toSrgb8(std::span<const float> r, std::span<const float> g,
                                    std::span<const float> b, float exposureEv) {
  const size_t count = std::min({r.size(), g.size(), b.size()});
  std::vector<uint8_t> rgb8(3 * count);
  for (size_t i = 0; i < count; ++i) {
    rgb8[3 * i] = toSrgb8(r[i], exposureEv);
    rgb8[3 * i + 1] = toSrgb8(g[i], exposureEv);
    rgb8[3 * i + 2] = toSrgb8(b[i], exposureEv);
  }
  return rgb8;
}

}  // namespace bnvpl
