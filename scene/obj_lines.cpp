#include "scene/obj_lines.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace bnvpl {
namespace {

// tinyobj cuts polygons into triangles in up to the cube of the number of corners: seconds for this
// many, weeks for a hundred times as many.
constexpr size_t kMaxCorners = 1024;

// At most: the words of the line but for "f".
size_t cornersOf(std::string_view line) {
  size_t words = 0;
  char before = ' ';
  for (const char c : line) {
    const bool space = c == ' ' || c == '\t';
    if (!space && (before == ' ' || before == '\t')) ++words;
    before = c;
  }
  return words - 1;
}

}  // namespace

size_t lineEnd(std::string_view text, size_t at) {
  // Not find_first_of, which is a call for each character.
  const auto ends = [](char c) { return c == '\n' || c == '\r'; };
  return static_cast<size_t>(
      std::find_if(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), ends) -
      text.begin());
}

MeshLines meshLines(const fs::path& file, std::string text) {
  static constexpr std::array<std::string_view, 8> kNeeded{"f", "v", "vn",     "vt",
                                                           "g", "o", "usemtl", "mtllib"};
  std::replace(text.begin(), text.end(), '\0', ' ');  // where tinyobj would stop
  MeshLines kept;
  kept.text.reserve(text.size() + 1);
  size_t number = 1;
  for (size_t at = 0; at < text.size();) {
    const size_t end = lineEnd(text, at);
    const std::string_view line = std::string_view(text).substr(at, end - at);
    const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const std::string_view keyword = line.substr(begin, line.find_first_of(" \t", begin) - begin);
    const size_t corners = keyword == "f" ? cornersOf(line) : 0;
    if (corners > kMaxCorners) {
      throw InputError(file.string() + ":" + std::to_string(number) + ": a face of more than " +
                       std::to_string(kMaxCorners) + " corners; triangulate the mesh");
    }
    if (std::find(kNeeded.begin(), kNeeded.end(), keyword) != kNeeded.end())
      kept.text.append(line) += '\n';
    kept.vertices += keyword == "v";
    kept.normals += keyword == "vn";
    kept.coordinates += keyword == "vt";
    kept.triangles += corners >= 3 ? corners - 2 : 0;
    if (end < text.size() && text[end] == '\n') ++number;
    at = end + 1;
  }
  return kept;
}

std::string firstLine(std::string text) {
  text.resize(std::min(text.size(), text.find('\n')));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

}  // namespace bnvpl
