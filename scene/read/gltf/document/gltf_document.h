// The container of a glTF: a .gltf is plain JSON, a .glb holds JSON and at most one block of bytes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// An error at a place in a glTF: "room.gltf#/accessors/3: problem; remedy". `pointer` is a JSON
// pointer (RFC 6901), "" for the whole file.
class GltfError : public InputError {
 public:
  GltfError(const fs::path& file, const std::string& pointer, const std::string& problem)
      : InputError(file.string() + "#" + (pointer.empty() ? "/" : pointer) + ": " + problem) {}
};

struct GltfDocument {
  fs::path file;
  nlohmann::json json;
  std::string binary;      // the BIN chunk of a .glb
  bool hasBinary = false;  // true even if that chunk is empty
};

// Reads either container, recognised by content. Throws InputError with the line of a JSON error or
// the byte of a GLB error, and for nesting deeper than any exporter's.
GltfDocument readGltfDocument(const fs::path& file);

}  // namespace bnvpl
