#pragma once

#include "core/memory.h"

namespace bnvpl {

// Calls requireMemory() for the number of rows in the header of a .vpl file. Also throws what
// readVplHeader() throws.
void requireMemoryFor(const fs::path& file, double bytesPerRow, const std::string& cure);

}  // namespace bnvpl
