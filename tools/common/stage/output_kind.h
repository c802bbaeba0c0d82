// Kinds of outputs, and whether an existing file is of a kind, so that it may be replaced: files of
// other programs are none, and neither are VPLs of another stage, which may be the work of hours.
// formats/shard/checkpoint.h recognises checkpoints.
#pragma once

#include <string>
#include <string_view>

#include "core/errors.h"
#include "formats/vpl/vpl_format.h"

namespace bnvpl {

enum class OutputKind {
  Candidates,
  Eliminated,
  Lit,
  Exr,
  Png,
  Svg,
  Ply,
  Csv,
  Shard,
  Contributions,
  Stats,
  Depfile
};

OutputKind kindOf(VplStage stage);

// Texts that our pictures and point clouds hold near their start, and that others do not.
inline constexpr std::string_view kSvgMark = "<defs><pattern id=\"lost\" ";
inline constexpr std::string_view kPlyMark = "comment vpl-inspect, ";

// ".vpl"; empty for kinds whose files may have any name: --stats and --depfile.
std::string extensionOf(OutputKind kind);
std::string contentOf(OutputKind kind);  // "an OpenEXR image"

// Judges the content, not the name: whether this project wrote the file, and as this kind. True
// also for a file that is empty, missing or unreadable; writing the output reports the last. Does
// not throw.
bool mayReplace(const fs::path& file, OutputKind kind);

// The tool that made the shard in `file`; empty where the file is no whole shard. Does not throw.
std::string makerOfShard(const fs::path& file);

}  // namespace bnvpl
