// Materials of MTL libraries and their textures -> those of a Scene.
#pragma once

#include <tbb/task_group.h>

#include <array>
#include <exception>
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

struct TextureField;  // of an MTL

class MaterialLoader {
 public:
  // Borrows both.
  MaterialLoader(Scene& scene, Warnings& warnings) : scene_(scene), warnings_(warnings) {}

  ~MaterialLoader();

  // Textures that will be wanted, to be read while the mesh is: nothing comes of it but time.
  void expectTextures(const fs::path& library, const fs::path& obj, const tinyobj::material_t& in);

  // Each returns the material's number in the scene. Textures are looked for beside the library,
  // then beside the OBJ; they are read by loadTextures().
  uint32_t add(const fs::path& library, const fs::path& obj, const tinyobj::material_t& in);
  uint32_t fallback(const fs::path& obj);  // for faces without a known material

  // Reads the textures that the scene's materials from `firstMaterial` on want.
  void loadTextures(size_t firstMaterial);

 private:
  struct WantedTexture {
    std::string key;  // file, use and place
    fs::path file;
    bool srgb, mask;
    std::array<float, 2> scale, offset;
  };
  struct Decoded {
    Texture texture;
    std::string problem;         // why there is none
    std::exception_ptr failure;  // why there can be no scene
  };
  // From here on a number stands for an entry of wanted_ rather than for a texture.
  static constexpr uint32_t kWanted = 1u << 31;

  static WantedTexture describe(const TextureField& field, const fs::path& library,
                                const fs::path& obj);
  void decode(const WantedTexture& wanted);
  uint32_t want(WantedTexture wanted);

  Scene& scene_;
  Warnings& warnings_;
  std::map<std::string, uint32_t> textures_;  // by key
  std::vector<WantedTexture> wanted_;         // of the OBJ that is being loaded
  std::map<std::string, Decoded> decoded_;    // by key, until loadTextures() takes it; see tasks_
  tbb::task_group tasks_;                     // each writes to its own entry
};

}  // namespace bnvpl
