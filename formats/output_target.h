// Where an output goes, and whether a file can be replaced there. Asks only; touches nothing.
#pragma once

#include "core/errors.h"

namespace bnvpl {

// `file` with its symbolic links followed to the end, which need not exist. Does not throw; a loop
// of links ends at one of them.
fs::path followLinks(const fs::path& file);

// The folder that holds `file`, "." for a bare name.
fs::path folderOf(const fs::path& file);

// followLinks(output), which a rename can replace: a regular file that may be written, or a name
// without a file in a folder that may be written. Throws OutputError for anything else: folders,
// devices, pipes, and open streams such as /dev/stdout, wherever they lead.
fs::path replaceableTarget(const fs::path& output);

}  // namespace bnvpl
