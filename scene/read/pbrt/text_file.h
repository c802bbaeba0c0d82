// Files of a pbrt scene that may be packed by gzip.
#pragma once

#include <string>

#include "core/errors.h"

namespace bnvpl::pbrt {

// The whole regular file, unpacked where it is packed, whatever its name. Throws InputError.
std::string readPacked(const fs::path& file);

}  // namespace bnvpl::pbrt
