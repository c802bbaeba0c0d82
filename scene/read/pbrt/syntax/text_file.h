// Reads files of a pbrt scene, which may be packed by gzip.
#pragma once

#include <string>

#include "core/errors.h"

namespace bnvpl::pbrt {

// The content of a regular file, unpacked if it is packed, whatever its name. Throws InputError.
std::string readPacked(const fs::path& file);

}  // namespace bnvpl::pbrt
