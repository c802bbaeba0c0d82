// Materials of MTL libraries and their textures -> those of a Scene.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace tinyobj {
struct material_t;
}

namespace bnvpl {

// Adds to scene.warnings, each text once.
class Warnings {
 public:
  explicit Warnings(Scene& scene) : scene_(scene) {}
  void add(const std::string& text) {
    if (given_.insert(text).second) scene_.warnings.push_back(text);
  }

 private:
  Scene& scene_;
  std::set<std::string> given_;
};

class MaterialLoader {
 public:
  // Borrows both.
  MaterialLoader(Scene& scene, Warnings& warnings) : scene_(scene), warnings_(warnings) {}

  // Each returns the material's number in the scene. Textures are looked for beside the library,
  // then beside the OBJ; they are read by loadTextures().
  uint32_t add(const fs::path& library, const fs::path& obj, const tinyobj::material_t& in);
  uint32_t fallback(const fs::path& obj);  // for faces without a known material

  // Reads the textures that the scene's materials from `firstMaterial` on want.
  void loadTextures(size_t firstMaterial);

 private:
  struct WantedTexture {
    std::string key;  // in textures_
    fs::path file;
    bool srgb, mask;
    std::array<float, 2> scale, offset;
  };
  // From here on a number stands for an entry of wanted_ rather than for a texture.
  static constexpr uint32_t kWanted = 1u << 31;

  uint32_t texture(const fs::path& folder, const fs::path& otherFolder, std::string name, bool srgb,
                   bool mask, const float* scale, const float* offset);

  Scene& scene_;
  Warnings& warnings_;
  std::map<std::string, uint32_t> textures_;  // by path and use
  std::vector<WantedTexture> wanted_;         // of the OBJ that is being loaded
};

}  // namespace bnvpl
