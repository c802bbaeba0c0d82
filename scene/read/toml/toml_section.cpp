#include "scene/read/toml/toml_section.h"

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "core/nearest_name.h"
#include "core/number_text.h"
#include "core/read_file.h"

namespace bnvpl {

namespace {

std::string lineOf(const fs::path& file, const toml::source_region& source) {
  return file.string() + ":" + std::to_string(source.begin.line) + ": ";
}

// toml++ nests one table for each dot of a.b.c.d and destroys them recursively, so that many dots
// overflow the stack. It limits nested brackets itself.
void refuseDeepKeys(const fs::path& file, const std::string& text) {
  constexpr size_t kMaxDots = 100;
  size_t line = 1, dots = 0;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      dots = 0;
    } else if (c == '.' && ++dots > kMaxDots) {
      throw InputError(file.string() + ":" + std::to_string(line) + ": more than " +
                       std::to_string(kMaxDots) + " dots in a line; break the line");
    }
  }
}

// File names of Windows often break this rule of TOML.
constexpr const char* kBackslashCure =
    "; in \"...\" a backslash begins an escape: write / in file names, or put them in '...'";

}  // namespace

toml::table parseToml(const fs::path& file) {
  if (!isRegularFile(file))
    throw InputError(file, whyUnreadable(file, "file") + "; name a scene.toml");
  const std::string text = readText(file);
  requireNoUtf16(file, text);
  refuseDeepKeys(file, text);
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& e) {
    const std::string problem(e.description());
    const bool escape = problem.find("escape sequence") != problem.npos;
    throw InputError(lineOf(file, e.source()) + problem + (escape ? kBackslashCure : ""));
  }
}

const toml::table& tableOf(const fs::path& file, const toml::table& root, const char* key) {
  const toml::node* node = root.get(key);
  const toml::table* table = node ? node->as_table() : nullptr;
  if (!node) throw InputError(file, std::string("needs a [") + key + "] section; add it");
  if (!table) {
    throw InputError(lineOf(file, node->source()) + "'" + key +
                     "' must be one table; write it as [" + key + "]");
  }
  return *table;
}

std::vector<const toml::table*> tablesOf(const fs::path& file, const toml::table& root,
                                         const char* key, const std::string& written) {
  std::vector<const toml::table*> tables;
  const toml::node* node = root.get(key);
  if (!node) return tables;
  const toml::array* array = node->as_array();
  for (size_t i = 0; array && i < array->size(); ++i) {
    if (const toml::table* t = array->get(i)->as_table()) tables.push_back(t);
  }
  if (!array || tables.size() != array->size()) {
    throw InputError(lineOf(file, node->source()) + "'" + key + "' must be written as [[" +
                     (written.empty() ? key : written) + "]]");
  }
  return tables;
}

bool toUnit(const FilePoint& to, const FilePoint& from, Vec3& unit) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  if (!(length > 0.0)) return false;
  unit = fromOrigin(
      {(to[0] - from[0]) / length, (to[1] - from[1]) / length, (to[2] - from[2]) / length}, {});
  return true;
}

TomlSection::TomlSection(const fs::path& file, std::string name, const toml::table& table,
                         const std::vector<std::string>& known)
    : file_(file), name_(std::move(name)), table_(table) {
  for (const auto& [key, node] : table_) checkKnown(std::string(key.str()), node, known);
}

void TomlSection::checkKnown(const std::string& key, const toml::node& node,
                             const std::vector<std::string>& known) const {
  if (std::find(known.begin(), known.end(), key) != known.end()) return;
  if (const std::string nearest = nearestName(key, known); !nearest.empty())
    fail(node, "unknown key '" + key + "'; did you mean '" + nearest + "'?");
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  fail(node, "unknown key '" + key + "'; the keys here are " + list);
}

void TomlSection::fail(const toml::node& node, const std::string& problem) const {
  throw InputError(lineOf(file_, node.source()) + name_ + ": " + problem);
}

std::string TomlSection::where(const char* key) const {
  return lineOf(file_, node(key).source()) + name_ + ": ";
}

const toml::node& TomlSection::node(const char* key) const {
  const toml::node* n = table_.get(key);
  if (!n) fail(std::string("needs '") + key + "'; add it");
  return *n;
}

double TomlSection::numberOf(const toml::node& n, const char* key, double lower,
                             double upper) const {
  const std::string quoted = std::string("'") + key + "'";
  const auto v = n.value<double>();
  if (!v || !std::isfinite(*v)) fail(n, quoted + " must be a number");
  if (*v < 0.0 && lower == 0.0)
    fail(n, quoted + " must not be negative, but is " + shortestText(*v));
  if (*v < lower || *v > upper) {
    fail(n, quoted + " is " + shortestText(*v) + ", outside " + shortestText(lower) + " to " +
                shortestText(upper));
  }
  return *v;
}

uint32_t TomlSection::integer(const char* key, uint32_t lower, uint32_t upper) const {
  const auto v = node(key).value_exact<int64_t>();
  if (!v || *v < int64_t{lower} || *v > int64_t{upper}) {
    fail(node(key), std::string("'") + key + "' must be a whole number from " +
                        std::to_string(lower) + " to " + std::to_string(upper));
  }
  return static_cast<uint32_t>(*v);
}

std::string TomlSection::text(const char* key) const {
  const auto v = node(key).value_exact<std::string>();
  if (!v) fail(node(key), std::string("'") + key + "' must be a text in quotes");
  return *v;
}

std::string TomlSection::fileName(const char* key) const {
  std::string name = text(key);
  if (name.empty()) fail(node(key), std::string("'") + key + "' is empty; name a file");
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; })) {
    fail(node(key), std::string("'") + key + "' holds a control character" + kBackslashCure);
  }
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

bool TomlSection::flag(const char* key, bool otherwise) const {
  if (!has(key)) return otherwise;
  const auto v = node(key).value_exact<bool>();
  if (!v) fail(node(key), std::string("'") + key + "' must be true or false");
  return *v;
}

uint32_t TomlSection::choice(const char* key, std::span<const char* const> names) const {
  const std::string given = text(key);
  const auto at = std::ranges::find(names, given);
  if (at != names.end()) return static_cast<uint32_t>(at - names.begin());
  std::string list;
  for (const char* name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  fail(node(key), std::string("'") + key + "' is '" + given + "'; use one of " + list);
}

std::string TomlSection::newName(const std::map<std::string, uint32_t>& known) const {
  const std::string name = text("name");
  if (name.empty()) fail(node("name"), "'name' must not be empty");
  if (known.contains(name))
    fail(node("name"), "the name '" + name + "' was given before; choose another");
  return name;
}

uint32_t TomlSection::known(const char* key, const std::string& kind,
                            const std::map<std::string, uint32_t>& numbers) const {
  const std::string name = text(key);
  const auto it = numbers.find(name);
  if (it == numbers.end()) {
    fail(node(key), std::string("'") + key + "': no " + kind + " '" + name +
                        "' stands before this; write it above");
  }
  return it->second;
}

std::vector<std::vector<double>> TomlSection::rows(const char* key, size_t rows,
                                                   size_t columns) const {
  constexpr std::array kNumbers{"no", "one", "two", "three", "four"};
  const toml::array* lines = node(key).as_array();
  std::vector<std::vector<double>> out(rows);
  for (size_t i = 0; i < rows; ++i) {
    const toml::array* row = lines && lines->size() == rows ? lines->get(i)->as_array() : nullptr;
    if (!row || row->size() != columns) {
      fail(node(key), std::string("'") + key + "' must be " + kNumbers[rows] + " rows of " +
                          kNumbers[columns] + " numbers");
    }
    for (size_t j = 0; j < columns; ++j)
      out[i].push_back(numberOf(*row->get(j), key, -kMaxMagnitude, kMaxMagnitude));
  }
  return out;
}

void TomlSection::requireOnly(const std::string& what, const std::set<std::string>& allowed) const {
  for (const auto& [key, node] : table_) {
    if (!allowed.contains(std::string(key.str()))) {
      fail(node, "'" + std::string(key.str()) + "' has no meaning for " + what + "; remove it");
    }
  }
}

FilePoint TomlSection::triple(const char* key, double lower, double upper) const {
  const toml::array* a = node(key).as_array();
  if (!a || a->size() != 3) fail(node(key), std::string("'") + key + "' must be [x, y, z]");
  FilePoint v;
  for (size_t i = 0; i < 3; ++i) v[i] = numberOf(*a->get(i), key, lower, upper);
  return v;
}

std::array<float, 2> TomlSection::pair(const char* key, double upper) const {
  const toml::array* a = node(key).as_array();
  if (!a || a->size() != 2) fail(node(key), std::string("'") + key + "' must be [x, y]");
  const auto at = [&](size_t i) {
    return static_cast<float>(numberOf(*a->get(i), key, -upper, upper));
  };
  return {at(0), at(1)};
}

Vec3 TomlSection::color(const char* key) const {
  return fromOrigin(triple(key, 0.0, kMaxMagnitude), {});
}

Vec3 TomlSection::direction(const char* key) const {
  Vec3 unit;
  if (!toUnit(point(key), {}, unit)) fail(node(key), std::string("'") + key + "' must not be zero");
  return unit;
}

}  // namespace bnvpl
