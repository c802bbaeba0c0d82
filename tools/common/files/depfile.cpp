#include "tools/common/files/depfile.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace bnvpl {
namespace {

std::string escaped(const fs::path& file) {
  std::string text;
  for (const char c : file.string()) {
    if (c == ' ') text += '\\';
    text += c;
  }
  return text;
}

}  // namespace

// A relative path of the folder could be the name of another target in ninja's graph.
fs::path inDepfile(const fs::path& file) {
  std::error_code ignored;
  fs::path found = file;
  while (!found.empty() && !fs::exists(found, ignored)) {
    const fs::path parent = found.parent_path();
    found = parent == found ? fs::path() : parent;
  }
  return found == file ? file : fs::absolute(found.empty() ? fs::path(".") : found);
}

std::string depfileProblem(const fs::path& file) {
  const std::string name = file.string();
  // Make and ninja read all other characters literally, except blanks, which are escaped.
  constexpr std::string_view kSpecial = "#$%*:;<=>?[\\]^`{|}~";
  const bool plain = std::ranges::all_of(name, [&](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= ' ' && byte != 0x7f && kSpecial.find(c) == std::string_view::npos;
  });
  // Make reads "A&:" as a grouped rule and "A(B)" as a member of an archive.
  if (plain && !name.ends_with('&') && !name.ends_with(')') && !name.ends_with(' ')) return {};
  return "--depfile: Make and ninja cannot read the name '" + name +
         "'; rename it, to letters, digits, blanks and ! \" & ' ( ) + , - . @ _";
}

void addDepfile(OutputSet& outputs, const fs::path& depfile, const fs::path& target,
                const std::vector<fs::path>& files) {
  if (depfile.empty()) return;
  std::string text = escaped(target) + ":";
  std::set<fs::path> listed;
  for (const fs::path& file : files) {
    const fs::path named = inDepfile(file);
    if (listed.insert(named).second) text += " \\\n  " + escaped(named);
  }
  outputs.add(depfile).write(text + "\n");
}

}  // namespace bnvpl
