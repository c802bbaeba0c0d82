#include "scene/texture.h"

#include <cmath>

#include "core/checked_malloc.h"
#include "formats/exr_io.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STBI_MALLOC(bytes) bnvpl::mallocOrThrow(bytes)
#define STBI_REALLOC(old, bytes) bnvpl::reallocOrThrow(old, bytes)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO_WRITE
#define STBI_NO_GIF
#define STBI_NO_PIC
#define STBI_MAX_DIMENSIONS 32768
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

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

// The texel centre of column i is at (i + 0.5) / width.
Bilinear bilinear(const Texture& t, float u, float v) {
  u = u * t.scale[0] + t.offset[0];
  v = v * t.scale[1] + t.offset[1];
  const float x = (u - std::floor(u)) * static_cast<float>(t.width) - 0.5f;
  const float y = (1.0f - (v - std::floor(v))) * static_cast<float>(t.height) - 0.5f;
  const float fx = x - std::floor(x), fy = y - std::floor(y);
  const auto wrap = [](float i, uint32_t n) {
    const auto k = static_cast<int64_t>(i) % static_cast<int64_t>(n);
    return static_cast<size_t>(k < 0 ? k + n : k);
  };
  const size_t x0 = wrap(std::floor(x), t.width), x1 = wrap(std::floor(x) + 1.0f, t.width);
  const size_t y0 = wrap(std::floor(y), t.height), y1 = wrap(std::floor(y) + 1.0f, t.height);
  return {{y0 * t.width + x0, y0 * t.width + x1, y1 * t.width + x0, y1 * t.width + x1},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

// The scale of the texture coordinates can take them out of range.
bool inRange(const Texture& t, float u, float v) {
  return std::isfinite(u * t.scale[0] + t.offset[0]) && std::isfinite(v * t.scale[1] + t.offset[1]);
}

}  // namespace

float srgbToLinear(uint8_t encoded) { return srgbTable()[encoded]; }

Vec3 Texture::lookup(float u, float v) const {
  if (!inRange(*this, u, v)) return {};
  const Bilinear b = bilinear(*this, u, v);
  const auto& table = srgbTable();
  Vec3 sum;
  for (int k = 0; k < 4; ++k) {
    const uint8_t* p = &rgba[4 * b.texel[k]];
    const Vec3 c = srgb ? Vec3{table[p[0]], table[p[1]], table[p[2]]}
                        : Vec3{float(p[0]), float(p[1]), float(p[2])} * (1.0f / 255.0f);
    sum += b.weight[k] * c;
  }
  return sum;
}

float Texture::lookupAlpha(float u, float v) const {
  if (!inRange(*this, u, v)) return 1.0f;
  const Bilinear b = bilinear(*this, u, v);
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k)
    sum += b.weight[k] * float(rgba[4 * b.texel[k] + 3]) * (1.0f / 255.0f);
  return sum;
}

Vec3 EnvironmentImage::lookup(float u, float v) const {
  const auto x = std::min(width - 1, static_cast<uint32_t>(u * static_cast<float>(width)));
  const auto y = std::min(height - 1, static_cast<uint32_t>(v * static_cast<float>(height)));
  return radiance[size_t{y} * width + x];
}

Texture loadTexture(const fs::path& file, bool srgb, bool mask) {
  int w = 0, h = 0, channels = 0;
  stbi_uc* pixels = stbi_load(file.c_str(), &w, &h, &channels, 4);
  if (!pixels) {
    throw InputError(file, std::string("cannot read the image: ") + stbi_failure_reason() +
                               "; supply a PNG, JPEG, TGA or BMP file");
  }
  Texture t;
  t.width = static_cast<uint32_t>(w);
  t.height = static_cast<uint32_t>(h);
  t.srgb = srgb;
  t.rgba.assign(pixels, pixels + size_t(4) * t.width * t.height);
  stbi_image_free(pixels);
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

}  // namespace

EnvironmentImage loadEnvironment(const fs::path& file) {
  EnvironmentImage e;
  if (file.extension() == ".exr") {
    e = fromExr(file);
  } else {
    int w = 0, h = 0, channels = 0;
    // stb decodes 8-bit images with a plain power; we want the sRGB curve.
    if (stbi_is_hdr(file.c_str())) {
      float* pixels = stbi_loadf(file.c_str(), &w, &h, &channels, 3);
      if (!pixels)
        throw InputError(file, std::string("cannot read the image: ") + stbi_failure_reason());
      const auto* rgb = reinterpret_cast<const Vec3*>(pixels);
      e.radiance.assign(rgb, rgb + size_t(w) * size_t(h));
      stbi_image_free(pixels);
      e.width = static_cast<uint32_t>(w);
      e.height = static_cast<uint32_t>(h);
    } else {
      const Texture t = loadTexture(file, true, false);
      e.width = t.width;
      e.height = t.height;
      e.radiance.resize(size_t{t.width} * t.height);
      for (size_t i = 0; i < e.radiance.size(); ++i) {
        e.radiance[i] = {srgbToLinear(t.rgba[4 * i]), srgbToLinear(t.rgba[4 * i + 1]),
                         srgbToLinear(t.rgba[4 * i + 2])};
      }
    }
  }
  for (size_t i = 0; i < e.radiance.size(); ++i) {
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
