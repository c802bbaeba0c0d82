// Describes a .shard: `vpl-inspect info`.
#pragma once

#include <string>

#include "core/errors.h"
#include "tools/common/options/stage_cli.h"

namespace bnvpl {

// Reads and verifies the whole file. Throws InputError.
Json describeShard(const fs::path& file);
std::string shardText(const Json& description);

}  // namespace bnvpl
