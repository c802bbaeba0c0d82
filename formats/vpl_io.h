// Reading and writing .vpl files. The layout is vpl_format.h.
#pragma once

#include <span>
#include <string_view>

#include "core/errors.h"
#include "formats/atomic_file.h"
#include "formats/vpl_format.h"
#include "formats/vpl_table.h"

namespace bnvpl {

// Reads and verifies a whole file; sets table.checksum. A file with no rows is valid.
// Throws InputError when it cannot be read, FileError (at a byte) when it is damaged.
VplTable readVpl(const fs::path& file);

// The same, and throws InputError when the file is not of the stage `expected`, before reading the
// columns. The message names the tool that made this file, as far as its provenance tells, and
// those that make the one that is needed.
VplTable readVpl(const fs::path& file, VplStage expected);

// Header and directory, verified against the real file size; the content is not looked at.
VplHeader readVplHeader(const fs::path& file);

// Replaces `file` atomically; an AtomicFile is left for the caller to commit. An empty provenance
// is written as "[]". Throws std::logic_error when the table holds a value that readVpl would
// refuse (naming its column and row): the stage should have found it where it arose. Throws
// OutputError when a write fails. The old file then stays as it was.
void writeVpl(const fs::path& file, const VplTable& table);
void writeVpl(AtomicFile& file, const VplTable& table);

// "candidates", "eliminated" or "lit"; and, for messages, the tools that make such a file.
std::string_view stageName(VplStage stage);
std::string_view stageTools(VplStage stage);

}  // namespace bnvpl
