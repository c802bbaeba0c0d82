#include "tools/render/film/features/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

namespace bnvpl {

namespace {

using Json = nlohmann::json;

constexpr uint32_t kC1 = 0xcc9e2d51u, kC2 = 0x1b873593u;

uint32_t scrambled(uint32_t k) { return std::rotl(k * kC1, 15) * kC2; }

uint32_t byteAt(std::string_view bytes, size_t i) { return static_cast<unsigned char>(bytes[i]); }

std::string hex(uint32_t value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", value);
  return text;
}

// JSON text of a name, in which what is no UTF-8 is U+FFFD.
std::string quoted(const std::string& name) {
  return Json(name).dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
}

std::string matteName(const std::string& name) {
  return name.empty() ? "default" : Json::parse(quoted(name)).get<std::string>();
}

}  // namespace

uint32_t murmurHash3(std::string_view bytes) {
  uint32_t h = 0;
  size_t at = 0;
  for (; at + 4 <= bytes.size(); at += 4) {
    uint32_t k = 0;
    for (size_t i = 4; i-- > 0;) k = k << 8 | byteAt(bytes, at + i);
    h = std::rotl(h ^ scrambled(k), 13) * 5 + 0xe6546b64u;
  }
  uint32_t tail = 0;
  for (size_t i = bytes.size(); i-- > at;) tail = tail << 8 | byteAt(bytes, i);
  h ^= scrambled(tail);
  h ^= static_cast<uint32_t>(bytes.size());
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

uint32_t cryptomatteId(std::string_view name) {
  constexpr uint32_t kMantissa = (1u << 23) - 1, kSign = 1u << 31;
  const uint32_t hash = murmurHash3(name);
  const uint32_t exponent = std::clamp(hash >> 23 & 255u, 1u, 254u);
  return (hash & kSign) | exponent << 23 | (hash & kMantissa);
}

std::vector<std::string> objectMatteNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const std::string& name : scene.objectNames) names.push_back(matteName(name));
  return names;
}

std::vector<std::string> materialMatteNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const Material& material : scene.materials) names.push_back(matteName(material.name));
  return names;
}

std::vector<MatteRank> rankMattes(std::vector<uint32_t>& ids, size_t samples) {
  std::ranges::sort(ids);
  std::vector<MatteRank> ranks;
  for (size_t begin = 0, end; begin < ids.size(); begin = end) {
    end = begin;
    while (end < ids.size() && ids[end] == ids[begin]) ++end;
    ranks.push_back({ids[begin], static_cast<float>(end - begin) / static_cast<float>(samples)});
  }
  std::ranges::stable_sort(ranks, std::greater{}, &MatteRank::coverage);
  return ranks;
}

void addMatteAttributes(const std::string& layer, std::span<const std::string> names,
                        std::map<std::string, std::string>& attributes) {
  const std::string key = "cryptomatte/" + hex(murmurHash3(layer)).substr(0, 7) + "/";
  std::string manifest;
  std::set<std::string> known;
  for (const std::string& name : names) {
    if (!known.insert(name).second) continue;
    manifest +=
        (manifest.empty() ? "" : ",") + quoted(name) + ":\"" + hex(cryptomatteId(name)) + "\"";
  }
  attributes[key + "name"] = layer;
  attributes[key + "hash"] = "MurmurHash3_32";
  attributes[key + "conversion"] = "uint32_to_float32";
  attributes[key + "manifest"] = "{" + manifest + "}";
}

}  // namespace bnvpl
