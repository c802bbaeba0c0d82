#include "formats/image/exr_header.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>

namespace bnvpl {
namespace {

constexpr size_t kOpeningBytes = 8;         // magic number, version and flags
constexpr unsigned char kMultiPart = 0x10;  // flag in the second byte of the version field
constexpr size_t kMaxName = 255;            // max length of a name in OpenEXR

// Attribute types of fixed size in OpenEXR.
const std::map<std::string_view, uint32_t> kFixedSizes{{"box2i", 16},
                                                       {"box2f", 16},
                                                       {"chromaticities", 32},
                                                       {"compression", 1},
                                                       {"deepImageState", 1},
                                                       {"double", 8},
                                                       {"envmap", 1},
                                                       {"float", 4},
                                                       {"int", 4},
                                                       {"keycode", 28},
                                                       {"lineOrder", 1},
                                                       {"m33f", 36},
                                                       {"m33d", 72},
                                                       {"m44f", 64},
                                                       {"m44d", 128},
                                                       {"rational", 8},
                                                       {"tiledesc", 9},
                                                       {"timecode", 8},
                                                       {"v2i", 8},
                                                       {"v2f", 8},
                                                       {"v2d", 16},
                                                       {"v3i", 12},
                                                       {"v3f", 12},
                                                       {"v3d", 24}};

// Reads sequentially from the start of the file; returns nothing at its end.
class Walk {
 public:
  explicit Walk(std::string_view bytes) : left_(bytes) {}
  std::string_view left() const { return left_; }

  bool skip(size_t bytes) {
    if (bytes > left_.size()) return false;
    left_.remove_prefix(bytes);
    return true;
  }
  std::optional<std::string_view> name() {
    const size_t length = left_.substr(0, kMaxName + 1).find('\0');
    if (length == std::string_view::npos) return std::nullopt;
    const std::string_view name = left_.substr(0, length);
    left_.remove_prefix(length + 1);
    return name;
  }
  std::optional<uint32_t> number() {
    if (left_.size() < 4) return std::nullopt;
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(left_[i]);
    left_.remove_prefix(4);
    return value;
  }

 private:
  std::string_view left_;
};

// Size of a channel list: names, each followed by 16 bytes, up to an empty name. Empty if the list
// has no end.
std::optional<size_t> channelListBytes(std::string_view bytes) {
  Walk walk(bytes);
  while (const auto name = walk.name()) {
    if (name->empty()) return bytes.size() - walk.left().size();
    if (!walk.skip(16)) break;
  }
  return std::nullopt;
}

// `left`: the bytes that were read from the attribute's value on; `inFile`: those of the file.
bool isHonest(std::string_view type, uint32_t claimed, std::string_view left, uint64_t inFile) {
  if (claimed > inFile) return false;
  if (type == "chlist") return claimed == channelListBytes(left);
  if (type == "floatvector") return claimed % 4 == 0;  // OpenEXR would leave a remainder unread
  const auto fixed = kFixedSizes.find(type);
  return fixed == kFixedSizes.end() || claimed == fixed->second;
}

// Checks the attributes in the first bytes of a file of `size` bytes. Returns whether the header,
// or the file, ends in them.
bool refuseDishonestIn(const fs::path& file, std::string_view bytes, uint64_t size) {
  Walk walk(bytes);
  if (!walk.skip(kOpeningBytes)) return bytes.size() == size;
  const bool multiPart = (static_cast<unsigned char>(bytes[5]) & kMultiPart) != 0;
  bool ended = true;  // an empty name ends the attributes of a part, a second one the header
  while (const auto name = walk.name()) {
    if (name->empty()) {
      if (ended || !multiPart) return true;
      ended = true;
      continue;
    }
    ended = false;
    const auto type = walk.name();
    const auto claimed = type ? walk.number() : std::nullopt;
    if (!claimed) break;
    // OpenEXR 3.1 reads eight bytes for a size that it counts as four, and so runs into the next
    // attribute.
    if (*type == "idmanifest") {
      throw InputError(file, "attribute '" + std::string(*name) +
                                 "' is an ID manifest, which OpenEXR 3.1 cannot read; save the "
                                 "image without it");
    }
    const uint64_t inFile = size - (bytes.size() - walk.left().size());
    if (*claimed > walk.left().size() && *claimed <= inFile) return false;
    if (!isHonest(*type, *claimed, walk.left(), inFile)) {
      throw InputError(file, "attribute '" + std::string(*name) + "' claims " +
                                 std::to_string(*claimed) +
                                 " bytes, which its type or the file does not have; make it again");
    }
    walk.skip(*claimed);
  }
  return bytes.size() == size;
}

}  // namespace

void refuseDishonestAttributes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code unknown;
  const uint64_t size = fs::file_size(file, unknown);
  if (unknown) return;
  std::string bytes;
  for (uint64_t part = 1 << 16;; part *= 4) {  // few headers are larger, and pixels are not needed
    const size_t had = bytes.size();
    bytes.resize(std::min(part, size));
    in.read(&bytes[had], static_cast<std::streamsize>(bytes.size() - had));
    if (!in) return;
    if (refuseDishonestIn(file, bytes, size)) return;
  }
}

}  // namespace bnvpl
