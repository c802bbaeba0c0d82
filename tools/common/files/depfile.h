// Dependency files for Make and ninja: "target: file file ...".
#pragma once

#include <string>
#include <vector>

#include "formats/atomic_file.h"

namespace bnvpl {

// Problem and cure of a file whose name Make or ninja cannot read in a depfile; else empty.
std::string depfileProblem(const fs::path& file);

// What a depfile names for an input: the file or, if it is missing, the absolute path of its
// nearest existing folder, which changes when the file appears.
fs::path inDepfile(const fs::path& file);

// Adds a depfile to the outputs of a run. Does nothing if `depfile` is empty.
void addDepfile(OutputSet& outputs, const fs::path& depfile, const fs::path& target,
                const std::vector<fs::path>& files);

}  // namespace bnvpl
