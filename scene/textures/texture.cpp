#include "scene/textures/texture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/files.h"
#include "core/prefetch.h"
#include "formats/image/pixels_io.h"
#include "scene/textures/exr_colours.h"
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

// std::floor, which baseline x86-64 compiles to a call. Numbers of 2^23 and more are whole.
float floorOf(float v) {
  if (!(std::fabs(v) < 0x1p23f)) return v;
  const auto whole = static_cast<float>(static_cast<int32_t>(v));
  return whole > v ? whole - 1.0f : whole;
}

// The centre of column i is at u = (i + 0.5) / width. Returns nothing for coordinates that are not
// finite, which an OBJ or the scale of an MTL can produce.
std::optional<Bilinear> bilinear(const Texture& t, float u, float v) {
  u = u * t.scale[0] + t.offset[0];
  v = v * t.scale[1] + t.offset[1];
  if (!std::isfinite(u) || !std::isfinite(v)) return std::nullopt;
  const float x = (u - floorOf(u)) * static_cast<float>(t.width) - 0.5f;
  const float y = (1.0f - (v - floorOf(v))) * static_cast<float>(t.height) - 0.5f;
  const float left = floorOf(x), top = floorOf(y), fx = x - left, fy = y - top;
  const auto wrap = [](int64_t i, int64_t n) {  // i is -1 to n, since u - floor(u) is 0 to 1
    return static_cast<size_t>(i < 0 ? i + n : i >= n ? i - n : i);
  };
  const auto column = static_cast<int64_t>(left), row = static_cast<int64_t>(top);
  const size_t x0 = wrap(column, t.width), x1 = wrap(column + 1, t.width);
  const size_t y0 = wrap(row, t.height), y1 = wrap(row + 1, t.height);
  return Bilinear{{y0 * t.width + x0, y0 * t.width + x1, y1 * t.width + x0, y1 * t.width + x1},
                  {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

Texture decodeColours(const fs::path& file, const std::string& bytes, bool srgb) {
  Pixels pixels = decodePixels(file, bytes, "EXR, HDR, PFM, ");
  Texture t;
  t.width = pixels.width;
  t.height = pixels.height;
  t.srgb = srgb;
  t.rgba = std::move(pixels.values);
  t.damage = std::move(pixels.damage);
  if (pixels.rounded)
    t.notes.push_back("16 bits a channel are rounded to 8; fine heights need an EXR or PFM");
  return t;
}

}  // namespace

float srgbToLinear(uint8_t encoded) { return srgbTable()[encoded]; }

Vec3 Texture::colourAt(size_t texel) const {
  if (rgba.empty()) return {floats[4 * texel], floats[4 * texel + 1], floats[4 * texel + 2]};
  const auto& table = srgbTable();
  const uint8_t* p = &rgba[4 * texel];
  return srgb ? Vec3{table[p[0]], table[p[1]], table[p[2]]}
              : Vec3{float(p[0]), float(p[1]), float(p[2])} * (1.0f / 255.0f);
}

Vec3 Texture::lookup(float u, float v) const {
  const std::optional<Bilinear> b = bilinear(*this, u, v);
  if (!b) return {};
  Vec3 sum;
  for (int k = 0; k < 4; ++k) sum += b->weight[k] * colourAt(b->texel[k]);
  return sum;
}

Vec3 Texture::texel(uint32_t column, uint32_t row) const {
  return colourAt(size_t{row} * width + column);
}

float Texture::texelAlpha(uint32_t column, uint32_t row) const {
  return alphaAt(size_t{row} * width + column);
}

bool Texture::hasAlpha() const {
  for (size_t texel = 0; texel < size_t{width} * height; ++texel)
    if (alphaAt(texel) != 1.0f) return true;
  return false;
}

void Texture::prefetch(float u, float v) const {
  const std::optional<Bilinear> b = bilinear(*this, u, v);
  if (!b || rgba.empty()) return;
  bnvpl::prefetch(&rgba[4 * b->texel[0]]);
  bnvpl::prefetch(&rgba[4 * b->texel[2]]);
}

float Texture::lookupAlpha(float u, float v) const {
  const std::optional<Bilinear> b = bilinear(*this, u, v);
  if (!b) return 1.0f;
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) sum += b->weight[k] * alphaAt(b->texel[k]);
  return sum;
}

Vec3 EnvironmentImage::lookup(float u, float v) const {
  const auto x = std::min(width - 1, static_cast<uint32_t>(u * static_cast<float>(width)));
  const auto y = std::min(height - 1, static_cast<uint32_t>(v * static_cast<float>(height)));
  return radiance[size_t{y} * width + x];
}

namespace {

// Converts colours of other primaries than Rec. 709's.
void convertToRec709(EnvironmentImage& e) {
  if (!e.primaries || isRec709(*e.primaries)) return;
  const std::optional<Matrix3> m = rec709From(*e.primaries);
  e.primaries.reset();
  if (!m) return;
  for (Vec3& L : e.radiance) L = vec3Of(times(*m, doubles(L)));
}

bool isExr(const fs::path& file) { return lowerExtension(file) == ".exr"; }
bool isFloats(const std::string& bytes) { return isRadianceHdr(bytes) || isPfm(bytes); }
EnvironmentImage decodeFloats(const fs::path& file, const std::string& bytes) {
  return isPfm(bytes) ? readPfm(file, bytes) : readRadianceHdr(file, bytes);
}

EnvironmentImage decodeEnvironment(const fs::path& file) {
  const std::string bytes = readBytes(file);
  if (isFloats(bytes)) return decodeFloats(file, bytes);
  const Texture t = decodeColours(file, bytes, true);
  EnvironmentImage e;
  e.width = t.width;
  e.height = t.height;
  e.damage = t.damage;
  e.radiance.resize(size_t{t.width} * t.height);
  for (size_t i = 0; i < e.radiance.size(); ++i) {
    e.radiance[i] = {srgbToLinear(t.rgba[4 * i]), srgbToLinear(t.rgba[4 * i + 1]),
                     srgbToLinear(t.rgba[4 * i + 2])};
  }
  return e;
}

// Sets negative values to 0 and returns the number of pixels that had some.
size_t requireFinite(const fs::path& file, EnvironmentImage& e) {
  size_t negative = 0;
  for (size_t i = 0; i < e.radiance.size(); ++i) {
    Vec3& L = e.radiance[i];
    if (!isFinite(L)) {
      throw InputError(file, "pixel " + std::to_string(i % e.width) + "," +
                                 std::to_string(i / e.width) + " is not finite; repair the image");
    }
    if (L.x >= 0 && L.y >= 0 && L.z >= 0) continue;
    L = max(L, Vec3{});
    ++negative;
  }
  return negative;
}

// `alpha` holds one value per texel, or is empty.
Texture textureOfFloats(const fs::path& file, EnvironmentImage image,
                        const std::vector<float>& alpha, bool srgb, bool mask) {
  if (srgb) convertToRec709(image);
  Texture t;
  t.width = image.width;
  t.height = image.height;
  t.srgb = false;
  t.negative = requireFinite(file, image);
  t.damage = image.damage;
  t.notes = std::move(image.notes);
  t.floats.reserve(4 * image.radiance.size());
  const bool varies = !alpha.empty() && std::ranges::any_of(alpha, [](float a) { return a != 1; });
  for (size_t i = 0; i < image.radiance.size(); ++i) {
    const Vec3 c = image.radiance[i];
    const float own = alpha.empty() || !std::isfinite(alpha[i]) ? 1.0f : alpha[i];
    t.floats.insert(t.floats.end(), {c.x, c.y, c.z, mask && !varies ? luminance(c) : own});
  }
  return t;
}

}  // namespace

Texture loadTexture(const fs::path& file, bool srgb, bool mask) {
  if (!isExr(file)) return decodeTexture(file, readBytes(file), srgb, mask);
  std::vector<float> alpha;
  EnvironmentImage image = readExrColours(file, &alpha);
  return textureOfFloats(file, std::move(image), alpha, srgb, mask);
}

Texture decodeTexture(const fs::path& name, const std::string& bytes, bool srgb, bool mask) {
  if (isFloats(bytes)) return textureOfFloats(name, decodeFloats(name, bytes), {}, srgb, mask);
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

EnvironmentImage loadEnvironment(const fs::path& file, size_t& negative) {
  EnvironmentImage e = isExr(file) ? readExrColours(file) : decodeEnvironment(file);
  convertToRec709(e);
  negative = requireFinite(file, e);
  return e;
}

}  // namespace bnvpl
