// Describes the contents of a file, as data and as text: `vpl-inspect info`.
#pragma once

#include "formats/image/image.h"
#include "formats/vpl/vpl_table.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

// Reads, verifies and describes a .vpl file, an OpenEXR image or a .shard. Keys carry their units.
// Throws InputError.
Json describeFile(const fs::path& file);

Json describeTable(const VplTable& table);
Json describeImage(const Image& image);

// The description for people: a few lines and one table, with a line feed at the end.
std::string infoText(const Json& description);

}  // namespace bnvpl
