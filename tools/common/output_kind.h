// What an output holds, and whether a file that stands at its name is an older one of that kind.
// Checkpoints are told by formats/checkpoint.h.
#pragma once

#include <string>

#include "core/errors.h"

namespace bnvpl {

enum class OutputKind { Vpl, Exr, Png, Svg, Ply, Csv, Shard, Stats, Depfile };

// ".vpl"; empty for those of any name: --stats and --depfile.
std::string extensionOf(OutputKind kind);
std::string contentOf(OutputKind kind);  // "an OpenEXR image"

// By content, whatever the name. An empty file is of every kind; so is one that cannot be read,
// which whoever replaces it refuses or reports. Does not throw.
bool mayReplace(const fs::path& file, OutputKind kind);

}  // namespace bnvpl
