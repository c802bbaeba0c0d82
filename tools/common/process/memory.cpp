#include "tools/common/process/memory.h"

#include "formats/vpl/vpl_io.h"

namespace bnvpl {

void requireMemoryFor(const fs::path& file, double bytesPerRow, const std::string& cure) {
  const uint64_t rows = readVplHeader(file).count;
  requireMemory(bytesPerRow * static_cast<double>(rows),
                file.string() + ": work on its " + std::to_string(rows) + " rows", cure);
}

}  // namespace bnvpl
