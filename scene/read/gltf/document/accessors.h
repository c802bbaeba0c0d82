// Reads accessors of a glTF as plain arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/read/gltf/document/gltf_model.h"

namespace bnvpl {

// Reads `components` numbers per element: SCALAR 1, VEC2 2, VEC3 3, VEC4 4, MAT4 16 (column-major).
// All component types are accepted. Integers of normalized accessors are scaled to 0..1 or -1..1,
// and sparse values are applied. Throws GltfError, which names the accessor. `known`: a number of
// elements that others have; without a buffer view, more are refused than that and 65,536.
std::vector<double> readNumbers(const GltfModel& model, int accessor, size_t components,
                                size_t known = 0);

// Reads a SCALAR accessor of unsigned integers.
std::vector<uint32_t> readIndices(const GltfModel& model, int accessor);

}  // namespace bnvpl
