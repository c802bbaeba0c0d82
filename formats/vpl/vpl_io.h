// Reads and writes .vpl files. The format is in vpl_format.h.
#pragma once

#include <span>
#include <string_view>

#include "core/errors.h"
#include "formats/atomic_file.h"
#include "formats/vpl/vpl_format.h"
#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// Reads and verifies a whole file, and sets table.checksum. A file without rows is valid. Throws
// InputError if it cannot be read, and FileError with the byte offset if it is damaged.
VplTable readVpl(const fs::path& file);

// The same, but throws InputError before reading the columns if the file is not of the stage
// `expected`. The message names the tool that made this file, if its provenance does, and the tools
// that make the required one: `makers`, or all of them.
VplTable readVpl(const fs::path& file, VplStage expected, std::string_view makers = {});

// Reads header and directory, and verifies them against the real file size, without the content.
VplHeader readVplHeader(const fs::path& file);

// Replaces `file` atomically; the caller commits an AtomicFile. An empty provenance is written as
// "[]". Throws std::logic_error, naming column and row, if the table has a value that readVpl()
// would refuse: the stage should have rejected it where it arose. Throws OutputError if a write
// fails. The old file is unchanged then.
void writeVpl(const fs::path& file, const VplTable& table);
void writeVpl(AtomicFile& file, const VplTable& table);

// The name of a stage, "candidates", "eliminated" or "lit"; and, for messages, the tools that make
// it.
std::string_view stageName(VplStage stage);
std::string_view stageTools(VplStage stage);

}  // namespace bnvpl
