// Textures and environment images.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/vec3.h"

namespace bnvpl {

// No index: of textures, materials, corners and everything else that is counted in 32 bits.
inline constexpr uint32_t kNone = 0xffffffffu;

// Texture of 8 bits a channel or of floats, repeated in both directions, v = 0 at the bottom row as
// in OBJ.
struct Texture {
  std::string name;  // its file, for people
  uint32_t width = 0, height = 0;
  bool srgb = true;           // decode to linear on lookup; false for masks and other plain data
  std::vector<uint8_t> rgba;  // row-major from the top
  // The same of an image of floats, linear and not negative; `rgba` is empty then.
  std::vector<float> floats;
  size_t negative = 0;  // texels of it that had negative values, which became 0
  std::array<float, 2> scale{1, 1}, offset{0, 0};  // of the texture coordinates (MTL -s, -o)

  Vec3 lookup(float u, float v) const;              // bilinear, linear sRGB
  Vec3 texel(uint32_t column, uint32_t row) const;  // linear sRGB
  float texelAlpha(uint32_t column, uint32_t row) const;
  void prefetch(float u, float v) const;      // what lookup() will read
  float lookupAlpha(float u, float v) const;  // bilinear; of the mask channel: see loadTexture

 private:
  Vec3 colourAt(size_t texel) const;
  float alphaAt(size_t texel) const {
    return rgba.empty() ? floats[4 * texel + 3] : float(rgba[4 * texel + 3]) * (1.0f / 255.0f);
  }
};

// Latitude-longitude radiance map; u = 0.5 looks along -z, v = 0 (top row) is +y.
struct EnvironmentImage {
  uint32_t width = 0, height = 0;
  std::vector<Vec3> radiance;           // row-major from the top
  Vec3 lookup(float u, float v) const;  // nearest texel, so that sampling by texel is exact
};

// PNG, JPEG, TGA, BMP, HDR or PFM, by content, or an EXR. Floats are linear whatever `srgb` says.
// For a mask, the alpha channel is filled from the image's own alpha if it has one that varies,
// else from its luminance. Throws InputError.
Texture loadTexture(const fs::path& file, bool srgb, bool mask);
// The same of its bytes, but for EXR; `name` is for messages.
Texture decodeTexture(const fs::path& name, const std::string& bytes, bool srgb, bool mask);

// EXR, HDR, PFM, or an 8-bit image (sRGB decoded). Negative values, which resampled images have,
// become 0; `negative` is the number of pixels that had some. Throws InputError; for values that
// are not finite, too.
EnvironmentImage loadEnvironment(const fs::path& file, size_t& negative);

float srgbToLinear(uint8_t encoded);

}  // namespace bnvpl
