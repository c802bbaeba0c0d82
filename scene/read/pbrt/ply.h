// PLY meshes, ASCII and binary of both byte orders.
//
// Read are x, y, z; nx, ny, nz; texture coordinates as u, v or s, t, alone or behind texture_; and
// faces as vertex_indices or vertex_index. Everything else is passed over.
#pragma once

#include <string_view>

#include "scene/read/pbrt/mesh_data.h"

namespace bnvpl::pbrt {

// Takes any bytes. Throws InputError. Faces of more than three corners are cut into triangles.
// `file` is for messages.
MeshData readPly(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl::pbrt
