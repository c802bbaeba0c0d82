#include "scene/textures/texture.h"

#include <cmath>
#include <optional>

#include "core/files.h"
#include "core/prefetch.h"
#include "formats/exr_io.h"
#include "formats/pixels_io.h"
#include "scene/textures/pfm.h"
#include "scene/textures/radiance_hdr.h"

namespace bnvpl {

namespace {

const std::array<float, 256>& srgbTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (size_t i = 0; i < 256; ++i) {
      const float c = static_cast<float>(i) / 255.0f;
      t[i] = c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
    }
    return t;
  }();
  return table;
}

struct Bilinear {  // four texels and their weights
  size_t texel[4];
  float weight[4];
};

// std::floor, which is a call on the baseline machine; larger numbers are whole.
float floorOf(float v) {
  if (!(std::fabs(v) < 0x1p23f)) return v;
  const auto whole = static_cast<float>(static_cast<int32_t>(v));
  return whole > v ? whole - 1.0f : whole;
}

// The texel centre of column i is at (i + 0.5) / width. None for coordinates that are not finite,
// which an OBJ or the scale of an MTL can make them.
std::optional<Bilinear> bilinear(const Texture& t, float u, float v) {
  u = u * t.scale[0] + t.offset[0];
  v = v * t.scale[1] + t.offset[1];
  if (!std::isfinite(u) || !std::isfinite(v)) return std::nullopt;
  const float x = (u - floorOf(u)) * static_cast<float>(t.width) - 0.5f;
  const float y = (1.0f - (v - floorOf(v))) * static_cast<float>(t.height) - 0.5f;
  const float left = floorOf(x), top = floorOf(y), fx = x - left, fy = y - top;
  const auto wrap = [](int64_t i, int64_t n) {  // of -1 to n, as u - floor(u) is 0 to 1
    return static_cast<size_t>(i < 0 ? i + n : i >= n ? i - n : i);
  };
  const auto column = static_cast<int64_t>(left), row = static_cast<int64_t>(top);
  const size_t x0 = wrap(column, t.width), x1 = wrap(column + 1, t.width);
  const size_t y0 = wrap(row, t.height), y1 = wrap(row + 1, t.height);
  return Bilinear{{y0 * t.width + x0, y0 * t.width + x1, y1 * t.width + x0, y1 * t.width + x1},
                  {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

Texture decodeColours(const fs::path& file, const std::string& bytes, bool srgb) {
  Pixels pixels = decodePixels(file, bytes, 4);
  Texture t;
  t.width = pixels.width;
  t.height = pixels.height;
  t.srgb = srgb;
  t.rgba = std::move(pixels.values);
  return t;
}

}  // namespace

float srgbToLinear(uint8_t encoded) { return srgbTable()[encoded]; }

Vec3 Texture::lookup(float u, float v) const {
  const std::optional<Bilinear> b = bilinear(*this, u, v);
  if (!b) return {};
  const auto& table = srgbTable();
  Vec3 sum;
  for (int k = 0; k < 4; ++k) {
    const uint8_t* p = &rgba[4 * b->texel[k]];
    const Vec3 c = srgb ? Vec3{table[p[0]], table[p[1]], table[p[2]]}
                        : Vec3{float(p[0]), float(p[1]), float(p[2])} * (1.0f / 255.0f);
    sum += b->weight[k] * c;
  }
  return sum;
}

Vec3 Texture::texel(uint32_t column, uint32_t row) const {
  const auto& table = srgbTable();
  const uint8_t* p = &rgba[4 * (size_t{row} * width + column)];
  return srgb ? Vec3{table[p[0]], table[p[1]], table[p[2]]}
              : Vec3{float(p[0]), float(p[1]), float(p[2])} * (1.0f / 255.0f);
}

float Texture::texelAlpha(uint32_t column, uint32_t row) const {
  return float(rgba[4 * (size_t{row} * width + column) + 3]) * (1.0f / 255.0f);
}

void Texture::prefetch(float u, float v) const {
  const std::optional<Bilinear> b = bilinear(*this, u, v);
  if (!b) return;
  bnvpl::prefetch(&rgba[4 * b->texel[0]]);
  bnvpl::prefetch(&rgba[4 * b->texel[2]]);
}

float Texture::lookupAlpha(float u, float v) const {
  const std::optional<Bilinear> b = bilinear(*this, u, v);
  if (!b) return 1.0f;
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k)
    sum += b->weight[k] * float(rgba[4 * b->texel[k] + 3]) * (1.0f / 255.0f);
  return sum;
}

Vec3 EnvironmentImage::lookup(float u, float v) const {
  const auto x = std::min(width - 1, static_cast<uint32_t>(u * static_cast<float>(width)));
  const auto y = std::min(height - 1, static_cast<uint32_t>(v * static_cast<float>(height)));
  return radiance[size_t{y} * width + x];
}

Texture loadTexture(const fs::path& file, bool srgb, bool mask) {
  return decodeTexture(file, readBytes(file), srgb, mask);
}

Texture decodeTexture(const fs::path& name, const std::string& bytes, bool srgb, bool mask) {
  Texture t = decodeColours(name, bytes, srgb);
  if (mask) {
    bool varies = false;
    for (size_t i = 3; i < t.rgba.size(); i += 4) varies |= t.rgba[i] != 255;
    if (!varies) {
      for (size_t i = 0; i < t.rgba.size(); i += 4) {
        t.rgba[i + 3] =
            static_cast<uint8_t>((54 * t.rgba[i] + 183 * t.rgba[i + 1] + 19 * t.rgba[i + 2]) >> 8);
      }
    }
  }
  return t;
}

namespace {

EnvironmentImage fromExr(const fs::path& file) {
  const Image image = readExr(file);
  const std::vector<float>*r = image.find("R"), *g = image.find("G"), *b = image.find("B");
  if (!r || !g || !b) throw InputError(file, "has no R, G and B channels; supply a colour image");
  EnvironmentImage e;
  e.width = static_cast<uint32_t>(image.width);
  e.height = static_cast<uint32_t>(image.height);
  e.radiance.resize(r->size());
  for (size_t i = 0; i < r->size(); ++i) e.radiance[i] = {(*r)[i], (*g)[i], (*b)[i]};
  return e;
}

EnvironmentImage decodeEnvironment(const fs::path& file) {
  const std::string bytes = readBytes(file);
  if (isRadianceHdr(bytes)) return readRadianceHdr(file, bytes);
  if (isPfm(bytes)) return readPfm(file, bytes);
  const Texture t = decodeColours(file, bytes, true);
  EnvironmentImage e{t.width, t.height, {}};
  e.radiance.resize(size_t{t.width} * t.height);
  for (size_t i = 0; i < e.radiance.size(); ++i) {
    e.radiance[i] = {srgbToLinear(t.rgba[4 * i]), srgbToLinear(t.rgba[4 * i + 1]),
                     srgbToLinear(t.rgba[4 * i + 2])};
  }
  return e;
}

}  // namespace

EnvironmentImage loadEnvironment(const fs::path& file, bool clampNegative) {
  EnvironmentImage e = lowerExtension(file) == ".exr" ? fromExr(file) : decodeEnvironment(file);
  for (size_t i = 0; i < e.radiance.size(); ++i) {
    if (clampNegative && isFinite(e.radiance[i])) e.radiance[i] = max(e.radiance[i], Vec3{});
    const Vec3 L = e.radiance[i];
    if (!isFinite(L) || L.x < 0 || L.y < 0 || L.z < 0) {
      throw InputError(file, "pixel " + std::to_string(i % e.width) + "," +
                                 std::to_string(i / e.width) +
                                 " is negative or not finite; repair the image");
    }
  }
  return e;
}

}  // namespace bnvpl
