#include "tools/inspect/file_kind.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/files.h"
#include "formats/shard/shard_file.h"
#include "formats/vpl/vpl_format.h"

namespace bnvpl {

FileKind fileKind(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored))
    throw InputError(file, "is a folder; name a .vpl file or an OpenEXR image");
  if (fs::exists(file, ignored) && !isRegularFile(file))
    throw InputError(file, "not a regular file; name a .vpl file or an OpenEXR image");
  std::ifstream in(file, std::ios::binary);
  if (!in.is_open()) {
    throw InputError(file, std::string("cannot open: ") + std::strerror(errno) +
                               "; check the name, or run the stage that makes it");
  }
  std::array<char, 8> start{};
  in.read(start.data(), start.size());
  constexpr std::array<char, 4> kExrMagic{'\x76', '\x2f', '\x31', '\x01'};
  if (start == kVplMagic) return FileKind::Vpl;
  if (start == ShardHeader{}.magic) return FileKind::Shard;
  if (std::memcmp(start.data(), kExrMagic.data(), kExrMagic.size()) == 0) return FileKind::Exr;
  const std::string extension = lowerExtension(file);
  if (extension == ".vpl") return FileKind::Vpl;
  if (extension == ".exr") return FileKind::Exr;
  if (extension == ".shard") return FileKind::Shard;
  throw InputError(file,
                   "is neither a .vpl file nor an OpenEXR image nor a .shard; name one of these, "
                   "or run vpl-inspect scene on a scene");
}

FileKind wholeFileKind(const fs::path& file) {
  const FileKind kind = fileKind(file);
  if (kind == FileKind::Shard) {
    throw InputError(file,
                     "is a part of a result; put all parts together with vpl-merge, or see what it "
                     "holds with vpl-inspect info");
  }
  return kind;
}

}  // namespace bnvpl
