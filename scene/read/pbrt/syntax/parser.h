// Parses the directives of pbrt files into a Description; build.h interprets types and parameters.
#pragma once

#include "scene/read/pbrt/syntax/description.h"

namespace bnvpl::pbrt {

// Reads the file and all that it includes. All file names, also in included files, are relative to
// the folder of `file`. Throws InputError with file, line, column, problem and remedy.
void parse(const fs::path& file, Description& out, Notes& notes);

}  // namespace bnvpl::pbrt
