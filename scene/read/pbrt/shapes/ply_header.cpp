#include "scene/read/pbrt/shapes/ply_header.h"

#include <charconv>
#include <map>
#include <sstream>

namespace bnvpl::pbrt {

namespace {

constexpr size_t kMaxHeader = 1 << 20;  // bytes

// The line of the header that is being read.
struct Line {
  const fs::path& file;
  size_t number = 0;
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file.string() + ":" + std::to_string(number) + ": " + problem +
                     "; export the mesh again");
  }
};

PlyType typeOf(const Line& line, const std::string& name) {
  static const std::map<std::string, PlyType> kTypes{
      {"char", PlyType::Int8},     {"int8", PlyType::Int8},     {"uchar", PlyType::Uint8},
      {"uint8", PlyType::Uint8},   {"short", PlyType::Int16},   {"int16", PlyType::Int16},
      {"ushort", PlyType::Uint16}, {"uint16", PlyType::Uint16}, {"int", PlyType::Int32},
      {"int32", PlyType::Int32},   {"uint", PlyType::Uint32},   {"uint32", PlyType::Uint32},
      {"float", PlyType::Float},   {"float32", PlyType::Float}, {"double", PlyType::Double},
      {"float64", PlyType::Double}};
  const auto known = kTypes.find(name);
  if (known == kTypes.end()) line.fail("the type '" + name.substr(0, 64) + "' is unknown");
  return known->second;
}

PlyProperty propertyOf(const Line& line, std::istringstream& words) {
  PlyProperty p;
  std::string type;
  words >> type;
  if (type == "list") {
    std::string count;
    words >> count >> type;
    p.isList = true;
    p.countType = typeOf(line, count);
    if (p.countType == PlyType::Float || p.countType == PlyType::Double)
      line.fail("the values of a list are counted by floats");
  }
  p.type = typeOf(line, type);
  words >> p.name;
  if (p.name.empty()) line.fail("a property has no name");
  return p;
}

// Minimum number of bytes of one instance of an element.
size_t leastBytes(const PlyElement& element, PlyFormat format) {
  if (format == PlyFormat::Ascii)
    return 2 * element.properties.size();  // except for the last blank
  size_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += p.isList ? sizeOf(p.countType) : sizeOf(p.type);
  return bytes;
}

void requireRoom(const fs::path& file, const PlyHeader& header, size_t size) {
  size_t left = size - header.bodyBegin + 1;
  for (const PlyElement& element : header.elements) {
    const size_t least = leastBytes(element, header.format);
    if (least > 0 ? element.count > left / least : element.count > left) {
      throw InputError(file, "ends before the " + std::to_string(element.count) + " of '" +
                                 element.name + "' that it claims; supply the whole file");
    }
    left -= least * element.count;
  }
}

}  // namespace

size_t sizeOf(PlyType type) {
  constexpr size_t kSizes[]{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

PlyHeader readPlyHeader(const fs::path& file, std::string_view bytes) {
  if (!bytes.starts_with("ply")) throw InputError(file, "is no PLY file; name one");
  PlyHeader header;
  bool hasFormat = false;
  Line line{file};
  for (size_t at = 0; at < std::min(bytes.size(), kMaxHeader);) {
    const size_t end = std::min(bytes.find('\n', at), bytes.size());
    std::istringstream words(std::string(bytes.substr(at, end - at)));
    at = end + 1;
    ++line.number;
    std::string word;
    words >> word;
    if (word == "format") {
      words >> word;
      hasFormat = true;
      if (word == "binary_little_endian") {
        header.format = PlyFormat::Little;
      } else if (word == "binary_big_endian") {
        header.format = PlyFormat::Big;
      } else if (word != "ascii") {
        line.fail("the format '" + word.substr(0, 64) + "' is unknown");
      }
    } else if (word == "element") {
      PlyElement element;
      std::string count;
      words >> element.name >> count;
      const char* last = count.data() + count.size();
      if (count.empty() || std::from_chars(count.data(), last, element.count).ptr != last)
        line.fail("'" + count.substr(0, 64) + "' is no number of '" + element.name + "'");
      header.elements.push_back(std::move(element));
    } else if (word == "property") {
      if (header.elements.empty()) line.fail("a property stands before any element");
      header.elements.back().properties.push_back(propertyOf(line, words));
    } else if (word == "end_header") {
      if (!hasFormat) line.fail("the header has no format");
      header.bodyBegin = std::min(at, bytes.size());
      requireRoom(file, header, bytes.size());
      return header;
    } else if (word != "ply" && word != "comment" && word != "obj_info" && !word.empty()) {
      line.fail("the header has the unknown line '" + word.substr(0, 64) + "'");
    }
  }
  throw InputError(file, "its header does not end; supply the whole file");
}

}  // namespace bnvpl::pbrt
