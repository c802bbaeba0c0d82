// Which of the project's binary files a path holds.
#pragma once

#include "core/errors.h"

namespace bnvpl {

enum class FileKind { Vpl, Exr, Shard };

// By the first bytes; a damaged start falls back on the extension, so that the reader can say what
// is wrong. Throws InputError when the file cannot be read or is none of them.
FileKind fileKind(const fs::path& file);
// The same for commands that take whole results: throws InputError for a shard.
FileKind wholeFileKind(const fs::path& file);

}  // namespace bnvpl
