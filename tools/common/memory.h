#pragma once

#include "core/memory.h"

namespace bnvpl {

// requireMemory() for the rows of a .vpl file, by its header. Throws what readVplHeader() throws.
void requireMemoryFor(const fs::path& file, double bytesPerRow, const std::string& cure);

}  // namespace bnvpl
