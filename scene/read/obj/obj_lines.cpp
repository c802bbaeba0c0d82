#include "scene/read/obj/obj_lines.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <set>
#include <string_view>

#include "core/parallel.h"
#include "scene/read/obj/obj_text.h"

namespace bnvpl {
namespace {

// tinyobj cuts polygons into triangles in up to the cube of the number of corners: seconds for this
// many, weeks for a hundred times as many.
constexpr size_t kMaxCorners = 1024;

// Where the line that holds `at` ends: at its "\r" or "\n", as for tinyobj, or with the text.
size_t lineEnd(std::string_view text, size_t at) {
  // Not find_first_of, which is a call for each character.
  const auto ends = [](char c) { return c == '\n' || c == '\r'; };
  return static_cast<size_t>(
      std::find_if(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), ends) -
      text.begin());
}

// At most: the words after "f".
size_t cornersOf(std::string_view face) {
  size_t words = 0;
  char before = ' ';
  for (const char c : face) {
    words += !isBlank(c) && isBlank(before);
    before = c;
  }
  return words;
}

// Whether a number may count back from where the face stands: it is below 0, or so long that
// tinyobj's int wraps.
bool mayCountBack(std::string_view face) {
  constexpr size_t kMaxDigits = 9;
  size_t digits = 0;
  for (const char c : face) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    if (c == '-' || digits > kMaxDigits) return true;
  }
  return false;
}

// The largest vertex number of a face's corners, "3" of "3/1/2"; those that count back are 0.
// Beyond any mesh where digits overflow.
size_t largestVertex(std::string_view face) {
  size_t largest = 0;
  for (size_t at = 0; at < face.size();) {
    const size_t begin = std::min(face.find_first_not_of(" \t", at), face.size());
    at = std::min(face.find_first_of(" \t", begin), face.size());
    size_t number = 0;
    const auto [end, error] = std::from_chars(face.data() + begin, face.data() + at, number);
    largest = std::max(largest, error == std::errc::result_out_of_range ? SIZE_MAX : number);
  }
  return largest;
}

// A stretch of whole lines.
struct Stretch {
  size_t begin = 0, end = 0;
  size_t newlines = 0;
  size_t vertices = 0, normals = 0, coordinates = 0, triangles = 0;
  std::vector<size_t> verticesOfWords;   // from its first vertex on
  std::set<std::string_view> materials;  // of faces, but for those before the first name
  bool facesBeforeNames = false;
  std::optional<std::string_view> material;  // named last
  bool materialUsed = false;
  std::vector<std::string_view> libraries;
  size_t largestOfPolygons = 0;  // of their vertices' numbers
  bool alone = true;             // its faces need nothing from other stretches
  size_t endlessFace = kNot;     // line, from its first on
  static constexpr size_t kNot = ~size_t{0};
};

void noteFace(std::string_view rest, Stretch& s) {
  const size_t corners = cornersOf(rest);
  if (corners > kMaxCorners) s.endlessFace = std::min(s.endlessFace, s.newlines);
  if (corners >= 3) s.triangles += corners - 2;
  if (corners > 3) s.largestOfPolygons = std::max(s.largestOfPolygons, largestVertex(rest));
  s.alone = s.alone && corners == 3 && !mayCountBack(rest);
  if (!s.material) {
    s.facesBeforeNames = true;
  } else if (!s.materialUsed) {
    s.materials.insert(*s.material);
    s.materialUsed = true;
  }
}

void noteVertex(std::string_view rest, Stretch& s) {
  const std::string_view numbers = rest.substr(0, rest.find('#'));
  const auto isOfNumber = [](char c) {
    return (c >= '0' && c <= '9') || isBlank(c) || c == '.' || c == '-' || c == '+' || c == 'e' ||
           c == 'E';
  };
  if (!std::all_of(numbers.begin(), numbers.end(), isOfNumber))
    s.verticesOfWords.push_back(s.vertices);
  ++s.vertices;
}

// Takes note of a line; false: tinyobj does not need it. A keyword alone is nothing to tinyobj
// either, but for usemtl.
bool note(std::string_view keyword, std::string_view rest, Stretch& s) {
  if (keyword == "usemtl") {
    s.material = trimmed(rest);
    s.materialUsed = false;
    return true;
  }
  if (rest.empty()) return false;
  if (keyword == "f") {
    noteFace(rest, s);
  } else if (keyword == "v") {
    noteVertex(rest, s);
  } else if (keyword == "vn") {
    ++s.normals;
  } else if (keyword == "vt") {
    ++s.coordinates;
  } else if (keyword == "mtllib") {
    if (!trimmed(rest).empty()) s.libraries.push_back(trimmed(rest));
    return false;
  } else {
    return keyword == "g" || keyword == "o";
  }
  return true;
}

void scan(std::string& text, Stretch& s) {
  std::replace(text.begin() + static_cast<std::ptrdiff_t>(s.begin),
               text.begin() + static_cast<std::ptrdiff_t>(s.end), '\0', ' ');  // tinyobj would stop
  const std::string_view all = std::string_view(text).substr(0, s.end);
  for (size_t at = s.begin; at < s.end;) {
    const size_t end = lineEnd(all, at);
    const std::string_view line = all.substr(at, end - at);
    const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const size_t length = std::min(line.find_first_of(" \t", begin), line.size()) - begin;
    const std::string_view keyword = line.substr(begin, length), rest = line.substr(begin + length);
    if (keyword == "usemtl") {
      const std::string_view name = trimmed(rest);
      char* first = text.data() + (name.data() - text.data());
      makeOneWord(first, first + name.size());
    }
    if (length > 0 && !note(keyword, rest, s)) text[at + begin] = '#';
    s.newlines += end < s.end && all[end] == '\n';
    at = end + 1;
  }
}

// Comments out the polygons that name a vertex beyond the last; returns how many triangles they
// were.
size_t dropLostPolygons(std::string& text, size_t vertices) {
  size_t lost = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = lineEnd(text, at);
    const std::string_view line = std::string_view(text).substr(at, end - at);
    const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    if (line.size() > begin + 1 && line[begin] == 'f' && isBlank(line[begin + 1])) {
      const std::string_view rest = line.substr(begin + 1);
      const size_t corners = cornersOf(rest);
      if (corners > 3 && largestVertex(rest) > vertices) {
        lost += corners - 2;
        text[at + begin] = '#';
      }
    }
    at = end + 1;
  }
  return lost;
}

// Of about `bytes` each.
std::vector<Stretch> stretchesOf(std::string_view text, size_t bytes) {
  std::vector<Stretch> out;
  for (size_t begin = 0; begin < text.size();) {
    const size_t at = std::min(text.size(), begin + bytes) - 1;
    const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    out.emplace_back().begin = begin;
    out.back().end = end;
    begin = end;
  }
  return out;
}

}  // namespace

MeshLines meshLines(const fs::path& file, std::string text, size_t pieceBytes) {
  MeshLines out;
  out.text = logicalLines(std::move(text));
  std::vector<Stretch> stretches = stretchesOf(out.text, pieceBytes);
  parallelFor(stretches.size(), 1, [&](size_t i) { scan(out.text, stretches[i]); });

  const bool many =
      std::all_of(stretches.begin(), stretches.end(), [](const Stretch& s) { return s.alone; });
  if (!many) out.pieces.push_back({0, out.text.size(), {}});
  std::set<std::string_view> materials;
  std::optional<std::string_view> material;
  size_t line = 1, largestOfPolygons = 0;
  for (const Stretch& s : stretches) {
    if (s.endlessFace != Stretch::kNot) {
      throw InputError(file.string() + ":" + std::to_string(line + s.endlessFace) +
                       ": a face of more than " + std::to_string(kMaxCorners) +
                       " corners; triangulate the mesh");
    }
    line += s.newlines;
    for (const size_t v : s.verticesOfWords) out.verticesOfWords.push_back(out.vertices + v);
    out.vertices += s.vertices;
    out.normals += s.normals;
    out.coordinates += s.coordinates;
    out.triangles += s.triangles;
    largestOfPolygons = std::max(largestOfPolygons, s.largestOfPolygons);
    out.libraries.insert(out.libraries.end(), s.libraries.begin(), s.libraries.end());
    materials.insert(s.materials.begin(), s.materials.end());
    if (s.facesBeforeNames) materials.insert(material.value_or(""));
    if (many) {
      out.pieces.push_back({s.begin, s.end, {}});
      if (material) out.pieces.back().material = std::string(*material);
    }
    if (s.material) material = s.material;
  }
  if (largestOfPolygons > out.vertices) {
    out.lostTriangles = dropLostPolygons(out.text, out.vertices);
    out.triangles -= out.lostTriangles;
  }
  for (const std::string_view word : materials) out.materials.push_back(fromOneWord(word));
  std::sort(out.materials.begin(), out.materials.end());
  return out;
}

}  // namespace bnvpl
