#include "scene/read/gltf/document/gltf_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>

#include "core/number_text.h"

namespace bnvpl {

namespace {

using Json = nlohmann::json;

constexpr double kMax = 1e30;  // largest coordinate, factor or power, as in scene.toml
constexpr double kAny = std::numeric_limits<double>::max();
constexpr double kMaxBytes = 0x1p40;  // largest size or offset; the sum of two does not overflow

struct Rule {
  enum class Kind { Object, Text, Flag, Number, Numbers, Whole, Index };
  std::string_view path;  // "*" matches each element of an array or member of an object
  Kind kind;
  bool required = false;
  double lower = -kMax, upper = kMax;
  size_t count = 0;          // Numbers: their count
  std::string_view of = {};  // Index: into this array
  bool clamped = false;      // numbers out of range are clamped, with a warning
};
using Kind = Rule::Kind;

constexpr Rule objectRule(std::string_view path) { return {path, Kind::Object}; }
constexpr Rule textRule(std::string_view path, bool required = false) {
  return {path, Kind::Text, required};
}
constexpr Rule flagRule(std::string_view path) { return {path, Kind::Flag}; }
constexpr Rule numberRule(std::string_view path, double lower = -kMax, double upper = kMax) {
  return {path, Kind::Number, false, lower, upper};
}
constexpr Rule numbersRule(std::string_view path, size_t count, double lower = -kMax,
                           double upper = kMax) {
  return {path, Kind::Numbers, false, lower, upper, count};
}
constexpr Rule sizeRule(std::string_view path, double lower = 0, double upper = kMaxBytes) {
  return {path, Kind::Whole, false, lower, upper};
}
constexpr Rule indexRule(std::string_view path, std::string_view of) {
  return {path, Kind::Index, false, 0, 0, 0, of};
}
constexpr Rule needed(Rule rule) {
  rule.required = true;
  return rule;
}

// Clamps the value: exporters write factors that rounding, or a user, has moved out of range.
constexpr Rule clamped(Rule rule) {
  rule.clamped = true;
  return rule;
}
constexpr Rule factorRule(std::string_view path) { return clamped(numberRule(path, 0, 1)); }

constexpr Rule kRules[] = {
    needed(objectRule("asset")),
    needed(textRule("asset/version")),
    textRule("asset/minVersion"),
    textRule("extensionsUsed/*"),
    textRule("extensionsRequired/*"),
    needed(sizeRule("buffers/*/byteLength", 1)),
    textRule("buffers/*/uri"),
    needed(indexRule("bufferViews/*/buffer", "buffers")),
    sizeRule("bufferViews/*/byteOffset"),
    needed(sizeRule("bufferViews/*/byteLength", 1)),
    sizeRule("bufferViews/*/byteStride", 4, 252),
    needed(indexRule("bufferViews/*/extensions/EXT_meshopt_compression/buffer", "buffers")),
    sizeRule("bufferViews/*/extensions/EXT_meshopt_compression/byteOffset"),
    needed(sizeRule("bufferViews/*/extensions/EXT_meshopt_compression/byteLength", 1)),
    needed(sizeRule("bufferViews/*/extensions/EXT_meshopt_compression/byteStride", 1, 256)),
    needed(sizeRule("bufferViews/*/extensions/EXT_meshopt_compression/count", 0, 0x1p31)),
    needed(textRule("bufferViews/*/extensions/EXT_meshopt_compression/mode")),
    textRule("bufferViews/*/extensions/EXT_meshopt_compression/filter"),
    indexRule("accessors/*/bufferView", "bufferViews"),
    sizeRule("accessors/*/byteOffset"),
    needed(sizeRule("accessors/*/componentType", 5120, 5126)),
    flagRule("accessors/*/normalized"),
    needed(sizeRule("accessors/*/count", 1, 0x1p31)),
    needed(textRule("accessors/*/type")),
    needed(sizeRule("accessors/*/sparse/count", 1, 0x1p31)),
    needed(indexRule("accessors/*/sparse/indices/bufferView", "bufferViews")),
    sizeRule("accessors/*/sparse/indices/byteOffset", 0, 0x1p31),
    needed(sizeRule("accessors/*/sparse/indices/componentType", 5121, 5125)),
    needed(indexRule("accessors/*/sparse/values/bufferView", "bufferViews")),
    sizeRule("accessors/*/sparse/values/byteOffset", 0, 0x1p31),
    textRule("meshes/*/name"),
    needed(objectRule("meshes/*/primitives/*")),
    needed(objectRule("meshes/*/primitives/*/attributes")),
    needed(indexRule("meshes/*/primitives/*/attributes/*", "accessors")),
    indexRule("meshes/*/primitives/*/indices", "accessors"),
    indexRule("meshes/*/primitives/*/material", "materials"),
    sizeRule("meshes/*/primitives/*/mode", 0, 6),
    objectRule("meshes/*/primitives/*/targets/*"),
    indexRule("meshes/*/primitives/*/targets/*/*", "accessors"),
    objectRule("skins/*"),
    indexRule("skins/*/joints/*", "nodes"),
    indexRule("skins/*/inverseBindMatrices", "accessors"),
    numberRule("meshes/*/weights/*", -1e6, 1e6),
    numberRule("nodes/*/weights/*", -1e6, 1e6),
    needed(indexRule("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView",
                     "bufferViews")),
    sizeRule("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*", 0, 0x1p31),
    textRule("nodes/*/name"),
    indexRule("nodes/*/children/*", "nodes"),
    numbersRule("nodes/*/matrix", 16),
    numbersRule("nodes/*/translation", 3),
    numbersRule("nodes/*/rotation", 4),
    numbersRule("nodes/*/scale", 3),
    indexRule("nodes/*/mesh", "meshes"),
    indexRule("nodes/*/camera", "cameras"),
    indexRule("nodes/*/skin", "skins"),
    needed(indexRule("nodes/*/extensions/KHR_lights_punctual/light",
                     "extensions/KHR_lights_punctual/lights")),
    needed(indexRule("nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", "accessors")),
    indexRule("scene", "scenes"),
    textRule("scenes/*/name"),
    indexRule("scenes/*/nodes/*", "nodes"),
    needed(textRule("cameras/*/type")),
    textRule("cameras/*/name"),
    needed(numberRule("cameras/*/perspective/yfov", 1e-5, 3.13)),
    numberRule("cameras/*/perspective/aspectRatio", 1e-3, 1e3),
    needed(textRule("extensions/KHR_lights_punctual/lights/*/type")),
    textRule("extensions/KHR_lights_punctual/lights/*/name"),
    clamped(numbersRule("extensions/KHR_lights_punctual/lights/*/color", 3, 0, 1e3)),
    clamped(numberRule("extensions/KHR_lights_punctual/lights/*/intensity", 0)),
    numberRule("extensions/KHR_lights_punctual/lights/*/range", -kAny, kAny),
    clamped(numberRule("extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", 0, 1.58)),
    clamped(numberRule("extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", 0, 1.58)),
    textRule("images/*/uri"),
    textRule("images/*/mimeType"),
    textRule("images/*/name"),
    indexRule("images/*/bufferView", "bufferViews"),
    indexRule("textures/*/source", "images"),
    indexRule("textures/*/sampler", "samplers"),
    sizeRule("samplers/*/wrapS"),
    sizeRule("samplers/*/wrapT"),
    sizeRule("samplers/*/magFilter"),
    textRule("materials/*/name"),
    clamped(numbersRule("materials/*/pbrMetallicRoughness/baseColorFactor", 4, 0, 1)),
    factorRule("materials/*/pbrMetallicRoughness/metallicFactor"),
    factorRule("materials/*/pbrMetallicRoughness/roughnessFactor"),
    clamped(numbersRule("materials/*/emissiveFactor", 3, 0, 1e3)),
    textRule("materials/*/alphaMode"),
    clamped(numberRule("materials/*/alphaCutoff", 0)),
    flagRule("materials/*/doubleSided"),
    numberRule("materials/*/normalTexture/scale"),
    clamped(
        numberRule("materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", 0)),
    clamped(numberRule("materials/*/extensions/KHR_materials_ior/ior", 0, 100)),
    factorRule("materials/*/extensions/KHR_materials_transmission/transmissionFactor"),
    factorRule("materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor"),
    factorRule("materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor"),
    numberRule("materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale"),
    factorRule("materials/*/extensions/KHR_materials_specular/specularFactor"),
    clamped(numbersRule("materials/*/extensions/KHR_materials_specular/specularColorFactor", 3, 0,
                        1e3)),
    objectRule("materials/*/extensions/KHR_materials_unlit"),
};

// All places where a material refers to a texture.
constexpr std::string_view kTextureInfos[] = {
    "pbrMetallicRoughness/baseColorTexture",
    "pbrMetallicRoughness/metallicRoughnessTexture",
    "normalTexture",
    "occlusionTexture",
    "emissiveTexture",
    "extensions/KHR_materials_transmission/transmissionTexture",
    "extensions/KHR_materials_clearcoat/clearcoatTexture",
    "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
    "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
    "extensions/KHR_materials_specular/specularTexture",
    "extensions/KHR_materials_specular/specularColorTexture"};
constexpr Rule kTextureRules[] = {needed(indexRule("/index", "textures")),
                                  sizeRule("/texCoord", 0, 1000),
                                  numbersRule("/extensions/KHR_texture_transform/offset", 2),
                                  numberRule("/extensions/KHR_texture_transform/rotation"),
                                  numbersRule("/extensions/KHR_texture_transform/scale", 2),
                                  sizeRule("/extensions/KHR_texture_transform/texCoord", 0, 1000)};

std::string escaped(const std::string& key) {  // RFC 6901
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

class Checker {
 public:
  Checker(GltfDocument& document, const std::function<void(const std::string&)>& warn)
      : document_(document), warn_(warn) {}

  void check(const Rule& rule) {
    if (rule.kind == Kind::Index) {
      const Json::json_pointer array("/" + std::string(rule.of));
      indexEnd_ = document_.json.contains(array) ? document_.json[array].size() : 0;
    }
    movedFirst_.clear();
    moved_ = 0;
    walk(rule, rule.path, document_.json, "");
    if (moved_ == 0) return;
    warn_(movedFirst_ +
          (moved_ > 1 ? ", also at " + std::to_string(moved_ - 1) + " places like it" : ""));
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const {
    throw GltfError(document_.file, pointer, problem);
  }

  void walk(const Rule& rule, std::string_view path, Json& at, const std::string& pointer) {
    if (path.empty()) return checkValue(rule, at, pointer);
    const size_t slash = path.find('/');
    const std::string key(path.substr(0, slash));
    const std::string_view rest =
        slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
    if (key == "*") return walkAll(rule, rest, at, pointer);
    if (!at.is_object()) fail(pointer, "must be an object; export the file again");
    const auto it = at.find(key);
    if (it != at.end()) return walk(rule, rest, *it, pointer + "/" + key);
    if (rule.required && rest.empty()) fail(pointer, "needs '" + key + "'; export the file again");
  }

  void walkAll(const Rule& rule, std::string_view rest, Json& at, const std::string& pointer) {
    if (!at.is_structured()) fail(pointer, "must be a list or an object; export the file again");
    if (at.is_array()) {
      for (size_t i = 0; i < at.size(); ++i)
        walk(rule, rest, at[i], pointer + "/" + std::to_string(i));
    } else {
      for (const auto& [key, value] : at.items())
        walk(rule, rest, value, pointer + "/" + escaped(key));
    }
  }

  void checkValue(const Rule& rule, Json& v, const std::string& pointer) {
    switch (rule.kind) {
      case Kind::Object:
        if (!v.is_object()) fail(pointer, "must be an object; export the file again");
        break;
      case Kind::Text:
        if (!v.is_string()) fail(pointer, "must be a text; export the file again");
        break;
      case Kind::Flag:
        if (!v.is_boolean()) fail(pointer, "must be true or false; export the file again");
        break;
      case Kind::Number:
        checkNumber(rule, v, pointer);
        break;
      case Kind::Numbers:
        if (!v.is_array() || v.size() != rule.count)
          fail(pointer, "must be " + std::to_string(rule.count) + " numbers");
        for (size_t i = 0; i < v.size(); ++i)
          checkNumber(rule, v[i], pointer + "/" + std::to_string(i));
        break;
      case Kind::Whole:
        if (!v.is_number_unsigned()) fail(pointer, "must be a whole number");
        checkNumber(rule, v, pointer);
        break;
      case Kind::Index:
        checkIndex(rule, v, pointer);
        break;
    }
  }

  void checkNumber(const Rule& rule, Json& v, const std::string& pointer) {
    if (!v.is_number()) fail(pointer, "must be a number; export the file again");
    const double number = v.get<double>();
    if (number >= rule.lower && number <= rule.upper) return;
    const std::string problem = "is " + shortestText(number) + ", outside " +
                                shortestText(rule.lower) + " to " + shortestText(rule.upper);
    if (!rule.clamped) fail(pointer, problem);
    v = std::clamp(number, rule.lower, rule.upper);
    if (moved_++ == 0) {
      movedFirst_ = document_.file.string() + "#" + pointer + ": " + problem + "; " +
                    shortestText(v.get<double>()) + " is used";
    }
  }

  void checkIndex(const Rule& rule, const Json& v, const std::string& pointer) {
    if (!v.is_number_unsigned()) fail(pointer, "must be an index");
    if (v.get<uint64_t>() < indexEnd_) return;
    fail(pointer, "is " + std::to_string(v.get<uint64_t>()) + ", but there are " +
                      std::to_string(indexEnd_) + " of " + std::string(rule.of) +
                      "; export the file again");
  }

  GltfDocument& document_;
  const std::function<void(const std::string&)>& warn_;
  // State of the current rule: end of its indices, number of clamped values, report of the first.
  size_t indexEnd_ = 0, moved_ = 0;
  std::string movedFirst_;
};

}  // namespace

void requireValid(GltfDocument& document, const std::function<void(const std::string&)>& warn) {
  Checker checker(document, warn);
  for (const Rule& rule : kRules) checker.check(rule);
  for (const std::string_view info : kTextureInfos) {
    for (Rule rule : kTextureRules) {
      const std::string path = "materials/*/" + std::string(info) + std::string(rule.path);
      rule.path = path;
      checker.check(rule);
    }
  }
  const Json& asset = document.json["asset"];
  const std::string version = asset["version"];
  if (!version.starts_with("2.")) {
    throw GltfError(document.file, "/asset/version",
                    "is '" + version + "'; glTF 2.0 is read, so export it as that");
  }
  const std::string minVersion = asset.value("minVersion", "2.0");
  unsigned major = 0, minor = 0;
  int end = -1;
  if (std::sscanf(minVersion.c_str(), "%4u.%4u%n", &major, &minor, &end) != 2 ||
      end != static_cast<int>(minVersion.size())) {
    throw GltfError(document.file, "/asset/minVersion",
                    "is '" + minVersion + "', not two numbers such as 2.0; mend or remove it");
  }
  if (major > 2 || (major == 2 && minor > 0)) {
    throw GltfError(document.file, "/asset/minVersion",
                    "is '" + minVersion + "'; glTF 2.0 is read, so export it as that");
  }
}

}  // namespace bnvpl
