// Kinds of outputs, and whether an existing file is of a kind, so that it may be replaced.
// formats/checkpoint.h recognises checkpoints.
#pragma once

#include <string>

#include "core/errors.h"

namespace bnvpl {

enum class OutputKind { Vpl, Exr, Png, Svg, Ply, Csv, Shard, Stats, Depfile };

// ".vpl"; empty for kinds whose files may have any name: --stats and --depfile.
std::string extensionOf(OutputKind kind);
std::string contentOf(OutputKind kind);  // "an OpenEXR image"

// Judges the content, not the name. True also for a file that is empty, missing or unreadable;
// writing the output reports the last. Does not throw.
bool mayReplace(const fs::path& file, OutputKind kind);

}  // namespace bnvpl
