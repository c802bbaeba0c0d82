// The directives of pbrt files -> Description. Syntax only: what types and parameters mean is
// for build.h.
#pragma once

#include "scene/read/pbrt/description.h"

namespace bnvpl::pbrt {

// Reads the file and all that it includes. Names of files in it are relative to its folder, those
// in included files too. Throws InputError: file, line, column, problem and cure.
void parse(const fs::path& file, Description& out, Notes& notes);

}  // namespace bnvpl::pbrt
