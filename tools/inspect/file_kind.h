// Which of the project's two binary files a path holds.
#pragma once

#include "core/errors.h"

namespace bnvpl {

enum class FileKind { Vpl, Exr };

// By the first bytes; a damaged start falls back on the extension, so that the reader can say what
// is wrong. Throws InputError when the file cannot be read or is neither.
FileKind fileKind(const fs::path& file);

}  // namespace bnvpl
