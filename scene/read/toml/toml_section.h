// A table of a TOML file, read key by key. Every error is one line with file, line, section,
// problem and remedy.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/affine.h"

namespace bnvpl {

// Throws InputError with the line of a syntax error.
toml::table parseToml(const fs::path& file);

// The section [key], which must exist, and the tables of [[key]], of which there may be none;
// `written` is the full name of a nested [[key]], for messages.
const toml::table& tableOf(const fs::path& file, const toml::table& root, const char* key);
std::vector<const toml::table*> tablesOf(const fs::path& file, const toml::table& root,
                                         const char* key, const std::string& written = "");

// Computes the unit vector from one point to another. Returns false if they coincide.
bool toUnit(const FilePoint& to, const FilePoint& from, Vec3& unit);

// Borrows the table and the file name. All functions throw InputError: the constructor for an
// unknown key, the readers for a key that is missing, of another type or out of range. Ranges
// include their limits.
class TomlSection {
 public:
  TomlSection(const fs::path& file, std::string name, const toml::table& table,
              const std::vector<std::string>& known);

  [[noreturn]] void fail(const toml::node& node, const std::string& problem) const;
  [[noreturn]] void fail(const std::string& problem) const { fail(table_, problem); }
  // The beginning of a message about a key that is there: "scene.toml:7: [[material]]: ".
  std::string where(const char* key) const;
  bool has(const char* key) const { return table_.contains(key); }
  const toml::node& node(const char* key) const;

  double number(const char* key, double lower, double upper) const {
    return numberOf(node(key), key, lower, upper);
  }
  double number(const char* key, double lower, double upper, double otherwise) const {
    return has(key) ? number(key, lower, upper) : otherwise;
  }
  double numberOf(const toml::node& n, const char* key, double lower, double upper) const;
  uint32_t integer(const char* key, uint32_t lower, uint32_t upper) const;
  std::string text(const char* key) const;
  // A text without control characters, with slashes for backslashes.
  std::string fileName(const char* key) const;
  std::array<float, 2> pair(const char* key, double upper) const;  // magnitudes up to `upper`
  FilePoint place(const char* key) const { return triple(key, -kMaxCoordinate, kMaxCoordinate); }
  bool flag(const char* key, bool otherwise) const;
  // Index of the text in `names`.
  uint32_t choice(const char* key, std::span<const char* const> names) const;
  // The text of 'name', which must be neither empty nor known.
  std::string newName(const std::map<std::string, uint32_t>& known) const;
  // The number of the text in `numbers`; `kind` is the section that defines it, for messages.
  uint32_t known(const char* key, const std::string& kind,
                 const std::map<std::string, uint32_t>& numbers) const;
  std::vector<std::vector<double>> rows(const char* key, size_t rows, size_t columns) const;
  // Refuses keys that would be ignored. `what` names the object, such as "a point light".
  void requireOnly(const std::string& what, const std::set<std::string>& allowed) const;
  FilePoint point(const char* key) const { return triple(key, -kMaxMagnitude, kMaxMagnitude); }
  Vec3 color(const char* key) const;                 // not negative
  Vec3 vector(const char* key, double upper) const {  // magnitudes up to `upper`
    return fromOrigin(triple(key, -upper, upper), {});
  }
  Vec3 direction(const char* key) const;  // unit length

  static constexpr double kMaxMagnitude = 1e30;  // limit of coordinates, factors and powers

 private:
  FilePoint triple(const char* key, double lower, double upper) const;
  void checkKnown(const std::string& key, const toml::node& node,
                  const std::vector<std::string>& known) const;

  const fs::path& file_;
  std::string name_;
  const toml::table& table_;
};

}  // namespace bnvpl
