// Primitives of glTF meshes as triangles.
#pragma once

#include <span>

#include "scene/read/gltf/pose.h"

namespace bnvpl {

// The arrays of a Mesh (scene_builder.h), owned.
struct GltfPrimitive {
  std::string pointer;                          // "/meshes/0/primitives/1"
  std::vector<double> positions, normals, uvs;  // v = 0 at the bottom row of a texture
  std::vector<Triangle> triangles;
};

// What a primitive's material asks of it.
struct GltfSurface {
  uint32_t material = kNone;  // a number of addMaterial()
  unsigned uvSet = 0;         // TEXCOORD_n
};

// The primitives of a mesh; with joints, in the coordinates of the scene. `surfaces` are those of
// the file's materials, then one for primitives without. Points and lines are left out with a
// warning. Throws GltfError.
std::vector<GltfPrimitive> readPrimitives(const GltfModel& model, size_t mesh,
                                          std::span<const GltfSurface> surfaces,
                                          const GltfPose& pose);

}  // namespace bnvpl
