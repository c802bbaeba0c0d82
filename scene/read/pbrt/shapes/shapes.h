// Tessellates the shapes of a pbrt file.
#pragma once

#include "scene/read/pbrt/syntax/description.h"
#include "scene/shapes/mesh_data.h"

namespace bnvpl::pbrt {

// The file of a plymesh; empty for other shapes. `folder` is the scene's folder.
fs::path meshFileOf(const Shape& shape, const fs::path& folder);

// May run in parallel on different shapes. An unknown shape gives only a note. Throws InputError
// with the place in the scene, or the PLY file.
MeshData tessellate(const Shape& shape, const fs::path& folder);

// The functions for each type of shape, declared for tessellate() and tests.
MeshData triangleMesh(const Params& params, const Place& place);
MeshData sphere(const Params& params);
MeshData disk(const Params& params);
MeshData cylinder(const Params& params);
MeshData bilinearMesh(const Params& params, const Place& place);
MeshData loopSubdivision(const Params& params, const Place& place);

}  // namespace bnvpl::pbrt
