// Reads primitives of glTF meshes as triangles.
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

// A material, and the texture coordinates that it needs of its primitives.
struct GltfSurface {
  uint32_t material = kNone;  // a number from addMaterial()
  unsigned uvSet = 0;         // TEXCOORD_n
};

// The primitives of a mesh, in its own coordinates, or in those of the scene if the pose has
// joints. `surfaces` holds one for each of the file's materials, then one for primitives without
// material. Points and lines are left out with a warning. Throws GltfError.
std::vector<GltfPrimitive> readPrimitives(const GltfModel& model, size_t mesh,
                                          std::span<const GltfSurface> surfaces,
                                          const GltfPose& pose);

}  // namespace bnvpl
