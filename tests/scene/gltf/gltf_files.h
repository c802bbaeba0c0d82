// Shared by the glTF tests: buffers as data URIs, and small files around a triangle.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <set>

#include "tests/scene/scene_files.h"

namespace bnvpl {

inline std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      out += i + k < bytes.size() + 1 ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

template <typename T>
std::string bytesOf(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}
inline std::string floats(const std::vector<float>& values) { return bytesOf(values); }

// The "min" and "max" members that an accessor of positions must have.
inline std::string bounds(const std::string& bytes) {
  std::vector<float> v(bytes.size() / sizeof(float));
  std::memcpy(v.data(), bytes.data(), v.size() * sizeof(float));
  std::string least, most;
  for (size_t axis = 0; axis < 3; ++axis) {
    float low = INFINITY, high = -INFINITY;
    for (size_t i = axis; i < v.size(); i += 3)
      low = std::min(low, v[i]), high = std::max(high, v[i]);
    const auto text = [](float x) {  // the shortest text that reads back equal
      char digits[32];
      return std::string(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
    };
    least += (axis > 0 ? "," : "") + text(low);
    most += (axis > 0 ? "," : "") + text(high);
  }
  return ",\"min\":[" + least + "],\"max\":[" + most + "]";
}

// Builds a glTF file: parts from their JSON, bytes in buffer views of one buffer.
class Gltf {
 public:
  // Appends a part to an array such as "nodes" and returns its index.
  size_t add(const std::string& array, const std::string& json) {
    std::vector<std::string>& list = listOf(array);
    list.push_back(json);
    return list.size() - 1;
  }
  size_t addView(const std::string& bytes, const std::string& members = "") {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const size_t view =
        add("bufferViews", "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
                               ",\"byteLength\":" + std::to_string(bytes.size()) + members + "}");
    bytes_ += bytes;
    return view;
  }
  // `type` is VEC3 or the like, `componentType` 5126 for floats.
  size_t addAccessor(const std::string& bytes, size_t count, const std::string& type,
                     int componentType = 5126, const std::string& members = "") {
    return add("accessors",
               "{\"bufferView\":" + std::to_string(addView(bytes)) +
                   ",\"componentType\":" + std::to_string(componentType) +
                   ",\"count\":" + std::to_string(count) + ",\"type\":\"" + type + "\"" + members +
                   (type == "VEC3" && componentType == 5126 ? bounds(bytes) : "") + "}");
  }
  size_t addMesh(const std::string& primitives) {
    return add("meshes", "{\"primitives\":[" + primitives + "]}");
  }
  // Adds the node as a root of scene 0.
  void show(const std::string& node) {
    const size_t number = add("nodes", node);
    roots += (roots.empty() ? "" : ",") + std::to_string(number);
  }

  // The file with its bytes as a data URI, or with `uri` in its place.
  std::string text(const std::string& uri = "") const {
    return json("{\"byteLength\":" + std::to_string(bytes_.size()) + ",\"uri\":\"" +
                (uri.empty() ? "data:application/octet-stream;base64," + base64(bytes_) : uri) +
                "\"}");
  }
  std::string glb() const {
    const std::string scene =
        padded(json("{\"byteLength\":" + std::to_string(bytes_.size()) + "}"), ' ');
    const std::string bin = padded(bytes_, '\0');
    return "glTF" + word(2) + word(12 + 8 + scene.size() + 8 + bin.size()) + word(scene.size()) +
           "JSON" + scene + word(bin.size()) + std::string("BIN\0", 4) + bin;
  }
  const std::string& bytes() const { return bytes_; }

  std::string more;        // members of the root: ",\"extensionsUsed\":[...]"
  std::string roots;       // indices of the root nodes of scene 0
  bool withScenes = true;  // else the file has no scenes, or those in `more`

 private:
  // The list of all extensions that the text names.
  static std::string used(const std::string& text) {
    static const std::regex name("\"(KHR|EXT)_\\w+\"");
    std::set<std::string> names;
    for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end; ++i)
      names.insert(i->str());
    std::string list;
    for (const std::string& n : names) list += (list.empty() ? "" : ",") + n;
    return list.empty() ? "" : ",\"extensionsUsed\":[" + list + "]";
  }
  static std::string padded(std::string bytes, char with) {
    bytes.resize((bytes.size() + 3) / 4 * 4, with);
    return bytes;
  }
  static std::string word(size_t value) {
    return bytesOf(std::vector<uint32_t>{static_cast<uint32_t>(value)});
  }
  std::vector<std::string>& listOf(const std::string& array) {
    for (auto& [name, list] : arrays_) {
      if (name == array) return list;
    }
    return arrays_.emplace_back(array, std::vector<std::string>()).second;
  }
  std::string json(const std::string& buffer) const {
    std::string out = "{\"asset\":{\"version\":\"2.0\"}";
    if (!bytes_.empty()) out += ",\"buffers\":[" + buffer + "]";
    for (const auto& [name, list] : arrays_) {
      out += ",\"" + name + "\":[";
      for (size_t i = 0; i < list.size(); ++i) out += (i > 0 ? "," : "") + list[i];
      out += "]";
    }
    if (withScenes)
      out += ",\"scenes\":[{" + (roots.empty() ? "" : "\"nodes\":[" + roots + "]") + "}]";
    if (more.find("extensionsUsed") == std::string::npos) out += used(out + more);
    return out + more + "}";
  }

  std::string bytes_;
  std::vector<std::pair<std::string, std::vector<std::string>>> arrays_;
};

// A right triangle in the plane z = 0 that faces +z, with legs of length 1 that meet at the origin.
inline const std::vector<float> kCorner{0, 0, 0, 1, 0, 0, 0, 1, 0};

inline const std::string kCornerBounds = bounds(floats(kCorner));

// A file with one accessor, 0: the positions of kCorner.
inline Gltf cornerGltf() {
  Gltf g;
  g.addAccessor(floats(kCorner), 3, "VEC3");
  return g;
}
// A file whose node 0 shows mesh 0, a triangle. `members` belong to its primitive.
inline Gltf triangleGltf(const std::string& members = "") {
  Gltf g = cornerGltf();
  g.addMesh("{\"attributes\":{\"POSITION\":0}" + members + "}");
  g.show("{\"mesh\":0}");
  return g;
}

// BNVPL_KEEP_GLTF=FOLDER keeps all files that load, for scripts/validate_gltf.sh.
class GltfFiles : public SceneFiles {
 protected:
  Scene load(const std::string& bytes, const std::string& name = "room.gltf") const {
    write(name, bytes);
    Scene scene = loadScene(at(name));
    if (const char* folder = std::getenv("BNVPL_KEEP_GLTF")) keep(folder);
    return scene;
  }
  Scene load(const Gltf& gltf) const { return load(gltf.text()); }
  std::string loadError(const std::string& bytes, const std::string& name = "room.gltf") const {
    try {
      load(bytes, name);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  std::string loadError(const Gltf& gltf) const { return loadError(gltf.text()); }

 private:
  void keep(const fs::path& folder) const {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    fs::copy(at(""), folder / (std::string(test->name()) + "-" + std::to_string(kept_++)),
             fs::copy_options::recursive);
  }
  mutable int kept_ = 0;
};

}  // namespace bnvpl
