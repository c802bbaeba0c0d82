// The header of a PLY file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace bnvpl::pbrt {

enum class PlyType : uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };
size_t sizeOf(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float;
  bool isList = false;
  PlyType countType = PlyType::Uint8;  // type of a list's count
};
struct PlyElement {
  std::string name;
  size_t count = 0;
  std::vector<PlyProperty> properties;
};
enum class PlyFormat { Ascii, Little, Big };
struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
  size_t bodyBegin = 0;  // byte offset
};

// Throws InputError, also if the bytes cannot hold as many elements as the header claims.
PlyHeader readPlyHeader(const fs::path& file, std::string_view bytes);

}  // namespace bnvpl::pbrt
