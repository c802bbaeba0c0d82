#include "scene/obj_lines.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace bnvpl {
namespace {

// tinyobj cuts polygons into triangles in up to the cube of the number of corners: seconds for this
// many, weeks for a hundred times as many.
constexpr size_t kMaxCorners = 1024;

// At most: the words of the line but for "f".
size_t cornersOf(const std::string& line) {
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

MeshLines meshLines(const fs::path& file, const std::string& text) {
  static const std::set<std::string> kNeeded{"v", "vn", "vt", "f", "g", "o", "usemtl", "mtllib"};
  MeshLines kept;
  size_t number = 1;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find_first_of("\r\n", at), text.size());  // as tinyobj does
    std::string line = text.substr(at, end - at);
    std::replace(line.begin(), line.end(), '\0', ' ');  // where tinyobj would stop
    const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const std::string keyword = line.substr(begin, line.find_first_of(" \t", begin) - begin);
    const size_t corners = keyword == "f" ? cornersOf(line) : 0;
    if (corners > kMaxCorners) {
      throw InputError(file.string() + ":" + std::to_string(number) + ": a face of more than " +
                       std::to_string(kMaxCorners) + " corners; triangulate the mesh");
    }
    if (kNeeded.contains(keyword)) kept.text += line + '\n';
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
