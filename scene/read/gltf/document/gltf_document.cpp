#include "scene/read/gltf/document/gltf_document.h"

#include <algorithm>
#include <cstring>

#include "core/files.h"
#include "core/read_file.h"

namespace bnvpl {

namespace {

constexpr uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBin = 0x004e4942;  // "glTF", ...
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

uint32_t wordAt(const std::string& bytes, size_t at) {  // little-endian
  uint32_t word = 0;
  for (size_t i = 0; i < 4; ++i)
    word |= uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return word;
}

// Limits nesting, since the parsers recurse at each level.
void refuseDeepNesting(const fs::path& file, std::string_view json) {
  constexpr size_t kMaxDepth = 64;
  size_t depth = 0, line = 1;
  bool inText = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '\n') ++line;
    if (inText) {
      if (c == '\\') ++i;
      inText = c != '"';
    } else if (c == '"') {
      inText = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxDepth) {
        throw InputError(file.string() + ":" + std::to_string(line) + ": is nested deeper than " +
                         std::to_string(kMaxDepth) + " levels; flatten it");
      }
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
}

nlohmann::json parseJson(const fs::path& file, std::string_view text) {
  refuseDeepNesting(file, text);
  try {
    nlohmann::json json = nlohmann::json::parse(text);
    if (json.is_object()) return json;
  } catch (const nlohmann::json::parse_error& e) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(e.byte, text.size()));
    throw InputError(file.string() + ":" + std::to_string(1 + std::count(text.begin(), end, '\n')) +
                     ": is no JSON that can be read; export it again");
  } catch (const nlohmann::json::exception&) {  // such as a number beyond double
    throw InputError(file, "holds a number out of range; export it again");
  }
  throw InputError(file, "is no glTF: its JSON is no object; export it again");
}

void readGlb(const std::string& bytes, GltfDocument& out) {
  const auto fail = [&](size_t at, const std::string& problem) {
    throw FileError(out.file, at, problem + "; export it again");
  };
  if (bytes.size() < kHeaderBytes) fail(bytes.size(), "the GLB ends within its header");
  if (const uint32_t version = wordAt(bytes, 4); version != 2)
    fail(4, "GLB version " + std::to_string(version) + " is not 2");
  const size_t end = wordAt(bytes, 8);
  if (end > bytes.size()) fail(bytes.size(), "the GLB was cut short");
  bool hasJson = false;
  for (size_t at = kHeaderBytes; at + kChunkHeaderBytes <= end;) {
    const size_t length = wordAt(bytes, at), begin = at + kChunkHeaderBytes;
    const uint32_t type = wordAt(bytes, at + 4);
    if (length > end - begin) fail(at, "a chunk of the GLB is longer than the file");
    if (!hasJson && type != kJson) fail(at, "the first chunk of the GLB is no JSON");
    if (!hasJson) {
      out.json = parseJson(out.file, std::string_view(bytes).substr(begin, length));
      hasJson = true;
    } else if (type == kBin && !out.hasBinary) {
      out.binary = bytes.substr(begin, length);
      out.hasBinary = true;
    }
    at = begin + (length + 3) / 4 * 4;
  }
  if (!hasJson) fail(kHeaderBytes, "the GLB has no JSON chunk");
}

}  // namespace

GltfDocument readGltfDocument(const fs::path& file) {
  if (!isRegularFile(file))
    throw InputError(file, whyUnreadable(file, "file") + "; name a .gltf or .glb");
  const std::string bytes = readText(file);
  requireNoUtf16(file, bytes);
  GltfDocument out{file, {}, {}, false};
  if (bytes.size() >= 4 && wordAt(bytes, 0) == kMagic)
    readGlb(bytes, out);
  else
    out.json = parseJson(file, bytes);
  return out;
}

}  // namespace bnvpl
