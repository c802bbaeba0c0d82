// Recognises the project's binary files.
#pragma once

#include "core/errors.h"

namespace bnvpl {

enum class FileKind { Vpl, Exr, Shard };

// Decides by the first bytes, or by the extension if they are damaged, so that the reader can
// report the damage. Throws InputError if the file cannot be read or is of no such kind.
FileKind fileKind(const fs::path& file);
// The same for commands that take complete results: throws InputError for a shard.
FileKind wholeFileKind(const fs::path& file);

}  // namespace bnvpl
