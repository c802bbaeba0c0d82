// "target: file file ...", as Make and ninja read it.
#pragma once

#include <vector>

#include "formats/atomic_file.h"

namespace bnvpl {

// Throws UsageError for a file whose name Make or ninja cannot read in a depfile.
void requireDepfileName(const fs::path& file);

// Adds a depfile to what the run makes. In place of a file that is missing stands its folder, which
// changes when the file arrives. Does nothing when `depfile` is empty.
void addDepfile(OutputSet& outputs, const fs::path& depfile, const fs::path& target,
                const std::vector<fs::path>& files);

}  // namespace bnvpl
