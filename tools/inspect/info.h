// What a file holds, as data and as text: `vpl-inspect info`.
#pragma once

#include "formats/image.h"
#include "formats/vpl_table.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

// Reads and verifies a .vpl file, an OpenEXR image or a .shard and describes it. Keys carry their
// units. Throws InputError.
Json describeFile(const fs::path& file);

Json describeTable(const VplTable& table);
Json describeImage(const Image& image);

// The same for people: a few lines and one table, ends with a line feed.
std::string infoText(const Json& description);

}  // namespace bnvpl
