// Shapes of a pbrt file -> triangles. Curved ones are cut finely; their corners lie a little
// outside of the shape, so that its area, and with it the power of a lamp, is exact.
#pragma once

#include "scene/read/pbrt/description.h"
#include "scene/read/pbrt/mesh_data.h"

namespace bnvpl::pbrt {

// The file of a plymesh; empty for other shapes. `folder` is the scene's.
fs::path meshFileOf(const Shape& shape, const fs::path& folder);

// Runs beside itself on other shapes. A shape that is not known gives nothing but a note. Throws
// InputError with the place in the scene, or the PLY file.
MeshData tessellate(const Shape& shape, const fs::path& folder);

// Each of its own parameters and file; declared here for tessellate() and tests.
MeshData triangleMesh(const Params& params, const Place& place);
MeshData sphere(const Params& params);
MeshData disk(const Params& params);
MeshData cylinder(const Params& params);
MeshData bilinearMesh(const Params& params, const Place& place);
MeshData loopSubdivision(const Params& params, const Place& place);

}  // namespace bnvpl::pbrt
