// OBJ and MTL files -> triangles, materials and textures of a Scene.
#pragma once

#include <vector>

#include "scene/affine.h"
#include "scene/read/obj/load_materials.h"
#include "scene/scene.h"

namespace bnvpl {

struct ObjReading;

class ObjLoader {
 public:
  explicit ObjLoader(Scene& scene) : scene_(scene) {}

  // Adds one OBJ. `materials` replaces the libraries that the OBJ names; empty: those are used.
  // Throws InputError when a file cannot be read at all; what can be repaired goes to
  // scene.warnings.
  void load(const fs::path& obj, const fs::path& materials, const Affine& transform);

  // After the last OBJ: rounds the vertices to floats, leaves out the triangles that have no area
  // or normal then, puts opaque ones first, computes bounds and origin, pads the vertex buffer.
  void finish();

 private:
  // materialOf: numbers in the scene of the reading's materials.
  void addTriangles(const fs::path& obj, const ObjReading& reading,
                    const std::vector<uint32_t>& materialOf, const Affine& transform);
  void roundPositions();
  void dropUnusable();
  void dropDoubledLamps();

  Scene& scene_;
  std::vector<FilePoint> points_;  // what scene_.positions will be
  struct Part {
    fs::path obj;
    size_t endTriangle;
  };
  std::vector<Part> parts_;
  Warnings warnings_{scene_};
  MaterialLoader materials_{scene_, warnings_};
};

}  // namespace bnvpl
