// Accessors of a glTF as plain arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/read/gltf/gltf_model.h"

namespace bnvpl {

// `components` numbers an element: SCALAR 1, VEC2 2, VEC3 3, VEC4 4, MAT4 16 (column by column). Of
// any component type; integers are scaled to 0..1 or -1..1 where the accessor is normalized. Sparse
// values are in place. Throws GltfError, which names the accessor.
std::vector<double> readNumbers(const GltfModel& model, int accessor, size_t components);

// Of a SCALAR of unsigned integers.
std::vector<uint32_t> readIndices(const GltfModel& model, int accessor);

}  // namespace bnvpl
