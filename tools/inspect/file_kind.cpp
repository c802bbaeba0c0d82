#include "tools/inspect/file_kind.h"

#include <array>
#include <cstring>
#include <fstream>

#include "core/files.h"
#include "formats/vpl_format.h"

namespace bnvpl {

FileKind fileKind(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) throw InputError(file, "is a folder");
  std::ifstream in;
  if (isRegularFile(file)) in.open(file, std::ios::binary);
  if (!in.is_open()) throw InputError(file, "cannot be read");
  std::array<char, 8> start{};
  in.read(start.data(), start.size());
  constexpr std::array<char, 4> kExrMagic{'\x76', '\x2f', '\x31', '\x01'};
  if (start == kVplMagic) return FileKind::Vpl;
  if (std::memcmp(start.data(), kExrMagic.data(), kExrMagic.size()) == 0) return FileKind::Exr;
  if (file.extension() == ".vpl") return FileKind::Vpl;
  if (file.extension() == ".exr") return FileKind::Exr;
  throw InputError(file, "is neither a .vpl file nor an OpenEXR image");
}

}  // namespace bnvpl
