// Where an output goes, and whether a file can be replaced there. These functions change nothing.
#pragma once

#include "core/errors.h"

namespace bnvpl {

// `file` with its symbolic links resolved; their end need not exist. Does not throw; a loop of
// links ends at one of them.
fs::path followLinks(const fs::path& file);

// The folder that holds `file`, "." for a bare name.
fs::path folderOf(const fs::path& file);

// Throws OutputError, which names `output`, if the system refuses a rename to `target` in spite of
// the rights of its folder: over another user's file in a folder with the sticky bit, over a mount
// or a protected file, or in an append-only folder.
void requireRenameTo(const fs::path& target, const fs::path& output);

// followLinks(output), if a rename can replace it: a writable regular file, or a new name in a
// writable folder. Throws OutputError for anything else: folders, devices, pipes, open streams such
// as /dev/stdout, wherever they lead, and "-".
fs::path replaceableTarget(const fs::path& output);

}  // namespace bnvpl
