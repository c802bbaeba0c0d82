#include "scene/textures/expression.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

namespace {

// Beyond this many squares, floats have hardly any fraction left, and the coordinate counts as 0.
constexpr float kLargest = 0x1p22f;
float wholeBelow(float x) { return std::fabs(x) < kLargest ? std::floor(x) : 0.0f; }

// Maps column or row i to 0..n-1 by the wrap mode. Returns false if the texel is black.
bool wrapped(Wrap wrap, int64_t i, int64_t n, uint32_t& out) {
  if (wrap == Wrap::Black && (i < 0 || i >= n)) return false;
  if (wrap == Wrap::Clamp) i = std::clamp<int64_t>(i, 0, n - 1);
  if (wrap == Wrap::Repeat) i = (i % n + n) % n;
  if (wrap == Wrap::Mirror) {
    i = (i % (2 * n) + 2 * n) % (2 * n);
    if (i >= n) i = 2 * n - 1 - i;
  }
  out = static_cast<uint32_t>(i);
  return true;
}

// A bilinearly interpolated texel: `alpha` alone for Channel::Alpha, else `colour` alone.
struct Texel {
  Vec3 colour;
  float alpha = 0.0f;
};
Texel texelsAt(const Texture& t, const TextureExpression& e, float u, float v) {
  u = u * t.scale[0] + t.offset[0];
  v = v * t.scale[1] + t.offset[1];
  const float x = u * static_cast<float>(t.width) - 0.5f;
  const float y = (1.0f - v) * static_cast<float>(t.height) - 0.5f;
  if (!(std::fabs(x) < 0x1p60f && std::fabs(y) < 0x1p60f)) return {};
  const float left = std::floor(x), top = std::floor(y);
  const auto column = static_cast<int64_t>(left), row = static_cast<int64_t>(top);
  Texel sum;
  for (int k = 0; k < 4; ++k) {
    const int right = k & 1, below = k >> 1;
    const float weight =
        (right ? x - left : 1.0f - (x - left)) * (below ? y - top : 1.0f - (y - top));
    uint32_t i = 0, j = 0;
    if (!wrapped(e.wrapU, column + right, t.width, i) ||
        !wrapped(e.wrapV, row + below, t.height, j))
      continue;
    if (e.channel == Channel::Alpha)
      sum.alpha += weight * t.texelAlpha(i, j);
    else
      sum.colour += weight * t.texel(i, j);
  }
  return sum;
}

Vec3 channelOf(Channel channel, const Texel& texel) {
  switch (channel) {
    case Channel::Rgb:
      return texel.colour;
    case Channel::Red:
      return Vec3(texel.colour.x);
    case Channel::Green:
      return Vec3(texel.colour.y);
    case Channel::Blue:
      return Vec3(texel.colour.z);
    case Channel::Alpha:
      return Vec3(texel.alpha);
    case Channel::Mean:
      return Vec3(mean(texel.colour));
  }
  return {};
}

}  // namespace

Vec3 TextureEvaluator::at(uint32_t expression, float u, float v) const {
  if (expression == kNone) return Vec3(1);
  const TextureExpression& e = expressions_[expression];
  const float tu = e.uv.a * u + e.uv.b * v + e.uv.c, tv = e.uv.d * u + e.uv.e * v + e.uv.f;
  switch (e.kind) {
    case TextureExpression::Kind::Constant:
      return e.value;
    case TextureExpression::Kind::Image: {
      if (e.image == kNone) return Vec3(1);
      const Vec3 c = e.value * channelOf(e.channel, texelsAt(textures_[e.image], e, tu, tv));
      return max(e.invert ? Vec3(1) - c : c, Vec3());
    }
    case TextureExpression::Kind::Product:
      return at(e.first, u, v) * at(e.second, u, v);
    case TextureExpression::Kind::Mix: {
      const float amount = std::clamp(at(e.amount, u, v).x, 0.0f, 1.0f);
      return (1.0f - amount) * at(e.first, u, v) + amount * at(e.second, u, v);
    }
    case TextureExpression::Kind::Checkerboard: {
      const float sum = wholeBelow(tu) + wholeBelow(tv);
      return at(sum == 2.0f * std::floor(0.5f * sum) ? e.first : e.second, u, v);
    }
  }
  return {};
}

Vec3 TextureEvaluator::mean(uint32_t expression) const {
  constexpr int kSide = 64;
  double sum[3] = {};
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3 c =
        at(expression, (float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide);
    for (size_t k = 0; k < 3; ++k) sum[k] += double{c[k]};
  }
  return Vec3(float(sum[0]), float(sum[1]), float(sum[2])) * (1.0f / (kSide * kSide));
}

std::array<float, 2> TextureEvaluator::texelSize(uint32_t expression) const {
  constexpr float kNoImage = 1.0f / 256;
  const auto found = finestTexel(expression);
  return {found[0] < kLargestTexel ? found[0] : kNoImage,
          found[1] < kLargestTexel ? found[1] : kNoImage};
}

std::array<float, 2> TextureEvaluator::finestTexel(uint32_t expression) const {
  std::array<float, 2> finest{kLargestTexel, kLargestTexel};
  if (expression == kNone) return finest;
  const TextureExpression& e = expressions_[expression];
  if (e.kind == TextureExpression::Kind::Image && e.image != kNone) {
    const Texture& t = textures_[e.image];
    const float width = std::fabs(t.scale[0]) * static_cast<float>(t.width),
                height = std::fabs(t.scale[1]) * static_cast<float>(t.height);
    const auto texels = [&](float across, float up) {  // that a unit of a coordinate passes
      return std::max(std::fabs(across) * width, std::fabs(up) * height);
    };
    constexpr float kMinTexels = 1.0f / kLargestTexel;
    return {1.0f / std::max(texels(e.uv.a, e.uv.d), kMinTexels),
            1.0f / std::max(texels(e.uv.b, e.uv.e), kMinTexels)};
  }
  for (const uint32_t operand : {e.first, e.second, e.amount}) {
    const auto its = finestTexel(operand);
    for (size_t k = 0; k < 2; ++k) finest[k] = std::min(finest[k], its[k]);
  }
  return finest;
}

}  // namespace bnvpl
