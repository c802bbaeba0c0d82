// The container of a glTF: a .gltf is its JSON, a .glb holds the JSON and up to one block of bytes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// What is wrong at a place of a glTF: "room.gltf#/accessors/3: problem; cure". `pointer` is a JSON
// pointer (RFC 6901), "" for the whole.
class GltfError : public InputError {
 public:
  GltfError(const fs::path& file, const std::string& pointer, const std::string& problem)
      : InputError(file.string() + "#" + (pointer.empty() ? "/" : pointer) + ": " + problem) {}
};

struct GltfDocument {
  fs::path file;
  nlohmann::json json;
  std::string binary;      // the BIN chunk of a .glb
  bool hasBinary = false;  // a chunk may be empty
};

// Told apart by content, not by extension. Throws InputError: for JSON that is none with its line,
// for a damaged .glb with its byte, for nesting deeper than any exporter's.
GltfDocument readGltfDocument(const fs::path& file);

}  // namespace bnvpl
