// Textures and environment images.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/vec3.h"
#include "scene/primaries.h"

namespace bnvpl {

// Stands for a missing index of a texture, material, corner or anything else counted in 32 bits.
inline constexpr uint32_t kNone = 0xffffffffu;

// Texture of 8 bits or one float per channel, repeated in both directions; v = 0 is the bottom row,
// as in OBJ.
struct Texture {
  std::string name;  // its file, for messages
  uint32_t width = 0, height = 0;
  bool srgb = true;           // decode to linear on lookup; false for masks and other plain data
  std::vector<uint8_t> rgba;  // row-major from the top
  // Texels of an image of floats, linear and not negative; `rgba` is then empty.
  std::vector<float> floats;
  size_t negative = 0;  // texels of `floats` whose negative values were set to 0
  std::string damage;   // why texels may be wrong; empty for a sound file
  std::vector<std::string> notes;                  // what of the file is read otherwise than asked
  std::array<float, 2> scale{1, 1}, offset{0, 0};  // transform texture coordinates (MTL -s, -o)

  Vec3 lookup(float u, float v) const;              // bilinear, linear sRGB
  Vec3 texel(uint32_t column, uint32_t row) const;  // linear sRGB
  float texelAlpha(uint32_t column, uint32_t row) const;
  bool hasAlpha() const;                      // whether the alpha of any texel is not 1
  void prefetch(float u, float v) const;      // prefetches what lookup() will read
  float lookupAlpha(float u, float v) const;  // bilinear; the mask: see loadTexture

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
  std::string damage;                   // why pixels may be wrong; empty for a sound file
  std::vector<std::string> notes;       // what of the file is read otherwise than asked
  std::optional<Primaries> primaries;   // those of `radiance`; empty: Rec. 709
  Vec3 lookup(float u, float v) const;  // nearest texel, as in the piecewise-constant density
};

// Reads PNG, JPEG, TGA, BMP, HDR or PFM, told apart by content, or EXR, by extension. Floats are
// linear whatever `srgb` says; those of colours, which `srgb` marks, are converted from the
// primaries that the file states. The alpha channel of a mask is the image's own alpha if that
// varies, else its luminance. Throws InputError.
Texture loadTexture(const fs::path& file, bool srgb, bool mask);
// Decodes the bytes of such a file, except for EXR; `name` is for messages.
Texture decodeTexture(const fs::path& name, const std::string& bytes, bool srgb, bool mask);

// Reads an EXR, HDR, PFM or 8-bit image (decoded from sRGB) as Rec. 709. Negative values, which
// resampling produces, become 0; `negative` is the number of pixels that had some. Throws
// InputError, also for values that are not finite.
EnvironmentImage loadEnvironment(const fs::path& file, size_t& negative);

float srgbToLinear(uint8_t encoded);

}  // namespace bnvpl
