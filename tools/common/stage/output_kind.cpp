#include "tools/common/stage/output_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/files.h"
#include "formats/image/png_io.h"
#include "formats/shard/shard_file.h"
#include "tools/common/stage/shard_info.h"

namespace bnvpl {
namespace {

using std::string_view_literals::operator""sv;

template <size_t N>
bool startsWith(std::string_view bytes, const std::array<char, N>& magic) {
  return bytes.starts_with(std::string_view(magic.data(), N));
}

std::string_view firstLine(std::string_view text) { return text.substr(0, text.find('\n')); }

bool isSvg(std::string_view text) {
  return text.starts_with("<svg "sv) && text.find(kSvgMark) != text.npos;
}

bool isPly(std::string_view text) {
  return text.starts_with("ply\nformat "sv) &&
         text.substr(0, text.find("\nelement "sv)).find(kPlyMark) != text.npos;
}

// The first line names the columns, of which these are in every stage.
bool isCsv(std::string_view text) {
  return text.starts_with(
      "position_x,position_y,position_z,normal_x,normal_y,normal_z,albedo_r,albedo_g,albedo_b,id"sv);
}

// VPLs of this stage, of any version. A file that does not tell a stage is damaged, and no loss.
bool isVplOf(std::string_view bytes, VplStage stage) {
  constexpr size_t kStageAt = 12;  // vpl_format.h asserts it
  uint32_t found = 0;
  if (!startsWith(bytes, kVplMagic)) return false;
  if (bytes.size() < kStageAt + sizeof found) return true;
  std::memcpy(&found, bytes.data() + kStageAt, sizeof found);
  const bool known = found >= static_cast<uint32_t>(VplStage::Candidates) &&
                     found <= static_cast<uint32_t>(VplStage::Lit);
  return !known || found == static_cast<uint32_t>(stage);
}

// Attributes are sorted by their names, and ours are the first.
bool isExr(std::string_view bytes) {
  return bytes.size() > 8 && bytes.starts_with("\x76\x2f\x31\x01"sv) &&
         bytes.substr(8).starts_with("bnvpl."sv);
}

// A PNG whose chunks before the pixels name this program.
bool isPng(std::string_view bytes) {
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n\0\0\0\rIHDR"sv) || bytes.size() <= 42) return false;
  return bytes.substr(0, bytes.find("IDAT"sv)).find(kPngMark) != bytes.npos;
}

// Whether JSON begins with this text, apart from white space.
bool isJson(std::string_view text, std::string_view start) {
  std::string dense;
  std::ranges::copy_if(text.substr(0, 256), std::back_inserter(dense),
                       [](unsigned char c) { return !std::isspace(c); });
  return dense.starts_with(start);
}

// A Make rule without commands, as addDepfile() writes it: a target, a colon, and files on
// continued lines.
bool isDepfile(std::string_view text) {
  std::string_view line = firstLine(text);
  if (!line.ends_with(": \\") && !line.ends_with(":")) return false;
  for (size_t begin = line.size() + 1; begin < text.size(); begin += line.size() + 1) {
    const bool goesOn = line.ends_with(" \\");
    line = firstLine(text.substr(begin));
    if (!goesOn || !line.starts_with(' ')) return false;
  }
  return true;
}

bool begins(std::string_view bytes, OutputKind kind) {
  switch (kind) {
    case OutputKind::Candidates:
      return isVplOf(bytes, VplStage::Candidates);
    case OutputKind::Eliminated:
      return isVplOf(bytes, VplStage::Eliminated);
    case OutputKind::Lit:
      return isVplOf(bytes, VplStage::Lit);
    case OutputKind::Exr:
      return isExr(bytes);
    case OutputKind::Png:
      return isPng(bytes);
    case OutputKind::Svg:
      return isSvg(bytes);
    case OutputKind::Ply:
      return isPly(bytes);
    case OutputKind::Csv:
      return isCsv(bytes);
    case OutputKind::Shard:
      return startsWith(bytes, ShardHeader{}.magic);
    case OutputKind::Contributions:
      return isJson(bytes, "{\"format\":\"bnvpl.contributions\"");
    case OutputKind::Stats:
      return isJson(bytes, "{\"tool\":\"vpl-");  // a glTF scene begins otherwise
    case OutputKind::Depfile:
      return isDepfile(bytes);
  }
  return false;
}

struct Name {
  const char *extension, *content;
};
Name nameOf(OutputKind kind) {
  static constexpr std::array<Name, 12> kNames{
      {{".vpl", "VPLs of stage candidates"},
       {".vpl", "VPLs of stage eliminated"},
       {".vpl", "VPLs of stage lit"},
       {".exr", "an OpenEXR image of vpl-render"},
       {".png", "a PNG picture of vpl-render or vpl-inspect"},
       {".svg", "an SVG picture of vpl-inspect"},
       {".ply", "a PLY point cloud of vpl-inspect"},
       {".csv", "a CSV table of vpl-inspect"},
       {".shard", "a shard"},
       {".json", "contributions of vpl-inspect"},
       {"", "the JSON summary of a run"},
       {"", "a list of files in Make syntax"}}};
  return kNames.at(static_cast<size_t>(kind));
}

}  // namespace

OutputKind kindOf(VplStage stage) {
  switch (stage) {
    case VplStage::Candidates:
      return OutputKind::Candidates;
    case VplStage::Eliminated:
      return OutputKind::Eliminated;
    case VplStage::Lit:
      break;
  }
  return OutputKind::Lit;
}

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

std::string makerOfShard(const fs::path& file) {
  try {
    const ShardInfo info = parseShardInfo(file, ShardReader(file).info());
    const auto tool = info.run.run.find("tool");
    if (tool != info.run.run.end() && tool->is_string()) return tool->get<std::string>();
  } catch (const std::exception&) {
    return "";
  }
  return "";
}

}  // namespace bnvpl
