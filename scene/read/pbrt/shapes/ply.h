// Reads PLY meshes, ASCII and binary of both byte orders.
//
// The reader takes x, y, z; nx, ny, nz; texture coordinates as u, v or s, t, alone or behind
// texture_; and faces as vertex_indices or vertex_index. It skips everything else.
#pragma once

#include <string_view>

#include "scene/shapes/mesh_data.h"

namespace bnvpl::pbrt {

// Accepts any bytes and throws InputError if they are no mesh. Faces of more than three corners are
// triangulated. `file` is for messages.
MeshData readPly(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl::pbrt
