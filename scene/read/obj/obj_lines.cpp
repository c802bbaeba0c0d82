#include "scene/read/obj/obj_lines.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string_view>

#include "core/parallel.h"
#include "scene/read/obj/obj_syntax.h"
#include "scene/read/obj/obj_text.h"
#include "scene/triangulate.h"

namespace bnvpl {
namespace {

// The end of the line that holds `at`: its "\r" or "\n", as for tinyobj, or the end of the text.
size_t lineEnd(std::string_view text, size_t at) {
  // find_first_of would make a call for each character.
  const auto ends = [](char c) { return c == '\n' || c == '\r'; };
  return static_cast<size_t>(
      std::find_if(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), ends) -
      text.begin());
}

// A range of whole lines, and what it holds.
struct Stretch {
  size_t begin = 0, end = 0;
  size_t newlines = 0;
  size_t vertices = 0, normals = 0, coordinates = 0, triangles = 0;
  size_t lostTriangles = 0, unusableFaces = 0;
  std::vector<size_t> verticesOfWords;   // counted from its first vertex
  std::set<std::string_view> materials;  // used by faces behind its first usemtl
  bool facesBeforeNames = false;
  std::optional<std::string_view> material;  // that of its last usemtl
  bool materialUsed = false;
  std::vector<std::string_view> libraries;
  size_t faces = 0;  // faces that tinyobj reports
  struct Name {
    size_t face;
    std::string_view name;
  };
  std::vector<Name> objects, groups;
  std::map<std::string, size_t> strange;  // unknown keywords, and their lines as for badLine
  size_t badLine = kNot;                  // counted from its first line
  std::string problem;                    // problem of that line
  static constexpr size_t kNot = ~size_t{0};
};

constexpr size_t kMaxStrange = 20;  // unknown keywords of a stretch that are remembered
constexpr size_t kMaxNamed = 32;    // characters of one that a message shows

// The keywords as a message names them, in the order of their lines.
std::vector<std::string> named(const std::map<std::string, size_t>& strange) {
  std::vector<std::pair<size_t, std::string_view>> byLine;
  for (const auto& [keyword, line] : strange) byLine.emplace_back(line, keyword);
  std::ranges::sort(byLine);
  std::vector<std::string> out;
  for (const auto& [line, keyword] : byLine)
    out.push_back("'" + std::string(keyword) + "' (line " + std::to_string(line) + ")");
  return out;
}

void noteProblem(const std::string& problem, Stretch& s) {
  if (problem.empty() || s.badLine != Stretch::kNot) return;
  s.badLine = s.newlines;
  s.problem = problem;
}

// Returns false if the face gives no triangle.
bool noteFace(std::string_view rest, Stretch& s) {
  const CornersOfLine corners = checkCorners(rest);
  noteProblem(corners.problem, s);
  if (corners.count > kMaxPolygonCorners) {
    noteProblem("a face of more than " + std::to_string(kMaxPolygonCorners) +
                    " corners; triangulate the mesh",
                s);
  }
  if (corners.count < 3) {
    ++s.unusableFaces;
    return false;
  }
  const bool lost = corners.largest > INT32_MAX;
  (lost ? s.lostTriangles : s.triangles) += corners.count - 2;
  if (lost) return false;
  ++s.faces;
  if (!s.material) {
    s.facesBeforeNames = true;
  } else if (!s.materialUsed) {
    s.materials.insert(*s.material);
    s.materialUsed = true;
  }
  return true;
}

void noteVertex(std::string_view rest, Stretch& s) {
  const NumbersOfLine numbers = checkNumbers("v", rest, 3, 3);
  noteProblem(numbers.problem, s);
  if (!numbers.finite) s.verticesOfWords.push_back(s.vertices);
  ++s.vertices;
}

// Keywords whose lines change no mesh: names, groups, points, lines, and how others draw it.
bool changesNoMesh(std::string_view keyword) {
  static constexpr std::array<std::string_view, 18> kKeywords{
      "s",      "mg",         "p",         "l",        "vp",    "vw",
      "t",      "bevel",      "c_interp",  "d_interp", "lod",   "usemap",
      "maplib", "shadow_obj", "trace_obj", "ctech",    "stech", "vc"};
  return keyword.starts_with('#') || std::ranges::find(kKeywords, keyword) != kKeywords.end();
}

// Takes note of a line. Returns false if tinyobj does not need it.
bool note(std::string_view keyword, std::string_view rest, Stretch& s) {
  if (keyword == "usemtl") {
    s.material = trimmed(rest);
    s.materialUsed = false;
    return true;
  }
  if (keyword == "f") return noteFace(rest, s);
  if (keyword == "v") {
    noteVertex(rest, s);
  } else if (keyword == "vn") {
    noteProblem(checkNumbers(keyword, rest, 3, 3).problem, s);
    ++s.normals;
  } else if (keyword == "vt") {
    noteProblem(checkNumbers(keyword, rest, 1, 2).problem, s);
    ++s.coordinates;
  } else if (keyword == "o" || keyword == "g") {
    (keyword == "o" ? s.objects : s.groups).push_back({s.faces, trimmed(rest)});
    return false;
  } else if (keyword == "mtllib") {
    if (!trimmed(rest).empty()) s.libraries.push_back(trimmed(rest));
    return false;
  } else {
    if (!changesNoMesh(keyword) && s.strange.size() < kMaxStrange)
      s.strange.try_emplace(std::string(keyword.substr(0, kMaxNamed)), s.newlines);
    return false;
  }
  return true;
}

// Blanks out a comment behind the numbers of a line of `text`.
std::string_view withoutComment(std::string_view rest, std::span<char> text) {
  size_t at = rest.find('#');
  while (at != rest.npos && at > 0 && !isBlank(rest[at - 1])) at = rest.find('#', at + 1);
  if (at == rest.npos) return rest;
  const auto from = text.begin() + (rest.data() - text.data()) + static_cast<std::ptrdiff_t>(at);
  std::fill(from, from + static_cast<std::ptrdiff_t>(rest.size() - at), ' ');
  return rest.substr(0, at);
}

// Blanks out slashes at the end of corners: tinyobj would read the next corner's number behind
// them.
void dropLastSlashes(std::string_view rest, std::span<char> text) {
  char* const first = text.data() + (rest.data() - text.data());
  bool atEnd = true;
  for (size_t i = rest.size(); i-- > 0;) {
    if (atEnd && first[i] == '/')
      first[i] = ' ';
    else
      atEnd = isBlank(first[i]);
  }
}

// Ranges of one text are scanned in parallel: nothing but the characters of the own range is
// written.
void scan(std::span<char> text, Stretch& s) {
  std::replace(text.begin() + static_cast<std::ptrdiff_t>(s.begin),
               text.begin() + static_cast<std::ptrdiff_t>(s.end), '\0', ' ');  // tinyobj stops at 0
  const std::string_view all(text.data(), s.end);
  for (size_t at = s.begin; at < s.end;) {
    const size_t end = lineEnd(all, at);
    const std::string_view line = all.substr(at, end - at);
    const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const size_t length = std::min(line.find_first_of(" \t", begin), line.size()) - begin;
    const std::string_view keyword = line.substr(begin, length);
    std::string_view rest = line.substr(begin + length);
    if (keyword == "f" || keyword == "v" || keyword == "vn" || keyword == "vt")
      rest = withoutComment(rest, text);
    if (keyword == "usemtl") {
      const std::string_view name = trimmed(rest);
      char* first = text.data() + (name.data() - text.data());
      makeOneWord(first, first + name.size());
    }
    if (keyword == "f") dropLastSlashes(rest, text);
    const bool unnamed = keyword == "usemtl" && rest.empty();
    if (length > 0 && !note(keyword, rest, s)) text[at + begin] = '#';
    // tinyobj ignores a usemtl without a name, but reports a group.
    if (unnamed) std::ranges::fill(text.subspan(at + begin, length), ' '), text[at + begin] = 'g';
    s.newlines += end < s.end && all[end] == '\n';
    at = end + 1;
  }
}

// Divides the text into ranges of about `bytes` each.
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

// Adds the names of a range whose first face is number `before`.
void appendNames(const std::vector<Stretch::Name>& names, size_t before,
                 std::vector<MeshLines::Object>& out) {
  for (const auto& [face, name] : names) out.push_back({before + face, std::string(name)});
}

}  // namespace

MeshLines meshLines(const fs::path& file, std::string text, size_t pieceBytes) {
  MeshLines out;
  out.text = logicalLines(std::move(text));
  std::vector<Stretch> stretches = stretchesOf(out.text, pieceBytes);
  parallelFor(stretches.size(), 1, [&](size_t i) { scan(out.text, stretches[i]); });

  std::set<std::string_view> materials;
  std::optional<std::string_view> material;
  std::map<std::string, size_t> strange;
  std::vector<MeshLines::Object> groups;
  size_t line = 1, faces = 0;
  for (const Stretch& s : stretches) {
    if (s.badLine != Stretch::kNot) {
      throw InputError(file.string() + ":" + std::to_string(line + s.badLine) + ": " + s.problem);
    }
    out.pieces.push_back({s.begin, s.end, out.vertices, out.normals, out.coordinates, {}});
    if (material) out.pieces.back().material = std::string(*material);
    for (const auto& [keyword, at] : s.strange) strange.try_emplace(keyword, line + at);
    line += s.newlines;
    for (const size_t v : s.verticesOfWords) out.verticesOfWords.push_back(out.vertices + v);
    out.vertices += s.vertices;
    out.normals += s.normals;
    out.coordinates += s.coordinates;
    out.triangles += s.triangles;
    out.lostTriangles += s.lostTriangles;
    out.unusableFaces += s.unusableFaces;
    appendNames(s.objects, faces, out.objects);
    appendNames(s.groups, faces, groups);
    faces += s.faces;
    out.libraries.insert(out.libraries.end(), s.libraries.begin(), s.libraries.end());
    materials.insert(s.materials.begin(), s.materials.end());
    if (s.facesBeforeNames) materials.insert(material.value_or(""));
    if (s.material) material = s.material;
  }
  if (out.objects.empty()) out.objects = std::move(groups);
  out.strangeKeywords = named(strange);
  for (const std::string_view word : materials) out.materials.push_back(fromOneWord(word));
  std::sort(out.materials.begin(), out.materials.end());
  return out;
}

}  // namespace bnvpl
