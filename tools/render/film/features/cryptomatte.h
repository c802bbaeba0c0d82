// Cryptomatte 1.1 (Friedman & Jones 2015; github.com/Psyop/Cryptomatte, specification): which
// objects or materials cover a pixel, and how much of it. Their names are hashed to floats.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// MurmurHash3_x86_32 with the seed 0 (Appleby, public domain).
uint32_t murmurHash3(std::string_view bytes);
// Bits of the float that stands for a name: its hash, with the exponent clamped to 1..254, so that
// it is neither zero, denormal, infinite nor NaN.
uint32_t cryptomatteId(std::string_view name);

// Names as they are hashed and as they stand in the manifest: valid UTF-8, never empty.
std::vector<std::string> objectMatteNames(const Scene& scene);
std::vector<std::string> materialMatteNames(const Scene& scene);

// Layers of RGBA channels, each with two pairs of id and coverage: "CryptoObject00" to "02".
inline constexpr size_t kMatteLayers = 3, kMatteRanks = 2 * kMatteLayers;

// The part of a pixel that one id covers.
struct MatteRank {
  uint32_t id = 0;        // bits of a float
  float coverage = 0.0f;  // share of the pixel's samples
};
// Orders ids by falling coverage; equal ones by rising hash. `ids`: one for each sample that hit
// something, in any order; it is sorted.
std::vector<MatteRank> rankMattes(std::vector<uint32_t>& ids, size_t samples);

// Adds the attributes that describe the layer called `layer`, which has mattes of these names.
void addMatteAttributes(const std::string& layer, std::span<const std::string> names,
                        std::map<std::string, std::string>& attributes);

}  // namespace bnvpl
