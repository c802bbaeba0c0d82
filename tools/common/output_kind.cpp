#include "tools/common/output_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/files.h"
#include "formats/shard_file.h"
#include "formats/vpl_format.h"

namespace bnvpl {
namespace {

using std::string_view_literals::operator""sv;

template <size_t N>
bool startsWith(std::string_view bytes, const std::array<char, N>& magic) {
  return bytes.starts_with(std::string_view(magic.data(), N));
}

std::string_view firstLine(std::string_view text) { return text.substr(0, text.find('\n')); }

bool isSvg(std::string_view text) {
  return text.starts_with("<svg"sv) ||
         (text.starts_with("<?xml"sv) && text.find("<svg"sv) != text.npos);
}

// The first line holds names, separated by commas.
bool isCsv(std::string_view text) {
  const std::string_view head = firstLine(text);
  return head.find(',') != head.npos && std::ranges::all_of(head, [](unsigned char c) {
           return std::isalnum(c) || "_,.\r"sv.find(static_cast<char>(c)) != std::string_view::npos;
         });
}

// The text begins with {"tool":"vpl-, apart from white space. Other JSON, such as a glTF scene,
// begins otherwise.
bool isStats(std::string_view text) {
  std::string dense;
  std::ranges::copy_if(text.substr(0, 256), std::back_inserter(dense),
                       [](unsigned char c) { return !std::isspace(c); });
  return dense.starts_with("{\"tool\":\"vpl-");
}

// Make rules without commands: a target, a colon, and files on continued lines.
bool isDepfile(std::string_view text) {
  const std::string_view head = firstLine(text);
  if (!head.ends_with(":") && !head.ends_with(" \\")) return false;
  if (head.find(':') == head.npos || text.find('\t') != text.npos) return false;
  for (size_t begin = head.size() + 1; begin < text.size();) {
    const std::string_view line = firstLine(text.substr(begin));
    if (!line.empty() && line.front() != ' ' && !line.ends_with(":") && !line.ends_with(" \\"))
      return false;
    begin += line.size() + 1;
  }
  return true;
}

bool begins(std::string_view bytes, OutputKind kind) {
  switch (kind) {
    case OutputKind::Vpl:
      return startsWith(bytes, kVplMagic);
    case OutputKind::Exr:
      return bytes.starts_with("\x76\x2f\x31\x01"sv);
    case OutputKind::Png:
      return bytes.starts_with("\x89PNG\r\n\x1a\n"sv);
    case OutputKind::Svg:
      return isSvg(bytes);
    case OutputKind::Ply:
      return bytes.starts_with("ply\n"sv) || bytes.starts_with("ply\r"sv);
    case OutputKind::Csv:
      return isCsv(bytes);
    case OutputKind::Shard:
      return startsWith(bytes, ShardHeader{}.magic);
    case OutputKind::Stats:
      return isStats(bytes);
    case OutputKind::Depfile:
      return isDepfile(bytes);
  }
  return false;
}

struct Name {
  const char *extension, *content;
};
Name nameOf(OutputKind kind) {
  static constexpr std::array<Name, 9> kNames{{{".vpl", "VPLs"},
                                               {".exr", "an OpenEXR image"},
                                               {".png", "a PNG picture"},
                                               {".svg", "an SVG picture"},
                                               {".ply", "a PLY point cloud"},
                                               {".csv", "a CSV table"},
                                               {".shard", "a shard"},
                                               {"", "the JSON summary of a run"},
                                               {"", "a list of files in Make syntax"}}};
  return kNames.at(static_cast<size_t>(kind));
}

}  // namespace

std::string extensionOf(OutputKind kind) { return nameOf(kind).extension; }
std::string contentOf(OutputKind kind) { return nameOf(kind).content; }

bool mayReplace(const fs::path& file, OutputKind kind) {
  std::ifstream in;
  if (isRegularFile(file)) in.open(file, std::ios::binary);
  if (!in.is_open()) return true;
  std::array<char, 4096> start{};
  in.read(start.data(), start.size());
  const std::string_view bytes(start.data(), static_cast<size_t>(in.gcount()));
  return bytes.empty() || begins(bytes, kind);
}

}  // namespace bnvpl
