#include "scene/read/obj/mtl/mtl_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <span>

#include "core/number_text.h"
#include "scene/read/obj/mtl/map_options.h"
#include "scene/read/obj/obj_syntax.h"
#include "scene/read/obj/obj_text.h"

namespace bnvpl {

namespace {

constexpr std::array<std::string_view, 6> kColours{"Ka", "Kd", "Ks", "Ke", "Kt", "Tf"};
constexpr std::array<std::string_view, 12> kNumbers{"Ns", "Ni", "d",  "Tr",  "illum", "Pr",
                                                    "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"};
constexpr std::array<std::string_view, 17> kMaps{
    "map_Ka",   "map_Kd", "map_Ks", "map_Ns", "map_Ke", "map_Pr", "map_Pm",   "map_Ps",  "map_Bump",
    "map_bump", "bump",   "map_d",  "disp",   "refl",   "norm",   "map_disp", "map_refl"};
constexpr std::array<std::string_view, 2> kWords{"newmtl", "emission_sides"};
// The format has them, and they would change no picture: they are of the quality of a lookup, and
// of a reflection map.
constexpr std::array<std::string_view, 2> kWithoutEffect{"map_aat", "sharpness"};
constexpr size_t kLongestKey = 40;  // that is shown

template <size_t N>
bool isOneOf(const std::array<std::string_view, N>& keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

bool sameLetters(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

// The keyword in the case that tinyobjloader knows.
std::string_view usualKey(std::string_view key) {
  std::string_view usual = key;
  const auto look = [&](const auto& keys) {
    if (isOneOf(keys, key)) usual = key;
    if (usual != key || isOneOf(keys, key)) return;
    const auto found = std::ranges::find_if(keys, [&](auto k) { return sameLetters(k, key); });
    if (found != keys.end()) usual = *found;
  };
  look(kColours);
  look(kNumbers);
  look(kMaps);
  look(kWords);
  look(kWithoutEffect);
  return usual;
}

// The value of a word that isNumber() accepts; infinite beyond what doubles hold.
double valueOf(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool small = word.find("e-") != word.npos || word.find("E-") != word.npos;
  if (parsed.ec == std::errc::result_out_of_range && !small)
    return std::numeric_limits<double>::infinity();
  return value;
}

class Lines {
 public:
  Lines(const fs::path& library, MtlNotes& notes) : library_(library), notes_(notes) {}

  void add(std::string_view line) {
    ++number_;
    const std::string_view trimmedLine = trimmed(line);
    const size_t blank = std::min(trimmedLine.find_first_of(" \t"), trimmedLine.size());
    const std::string_view key = usualKey(trimmedLine.substr(0, blank)),
                           rest = trimmed(trimmedLine.substr(blank));
    if (key == "newmtl") {
      material_ = rest;
      notes_.lines.try_emplace(material_, number_);
    }
    if (isOneOf(kColours, key))
      addColour(key, rest);
    else if (isOneOf(kNumbers, key))
      addNumber(key, rest);
    else if (isOneOf(kMaps, key) && !rest.empty())
      addMap(key, rest);
    else
      addOther(key, rest);
  }
  std::string take() { return std::move(text_); }

 private:
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const {
    throw InputError(library_.string() + ":" + std::to_string(number_) + ": " + std::string(key) +
                     ": " + problem);
  }
  void note(std::string_view key, const std::string& text) {
    notes_.byMaterial[material_].push_back(library_.string() + ":" + std::to_string(number_) +
                                           ": material '" + material_ + "': " + std::string(key) +
                                           text);
  }
  void write(std::string_view key, std::string_view rest) {
    text_.append(key).append(rest.empty() ? "" : " ").append(rest) += '\n';
  }

  void addOther(std::string_view key, std::string_view rest) {
    const bool known = isOneOf(kWords, key) || isOneOf(kMaps, key) || isOneOf(kWithoutEffect, key);
    if (!known && !key.empty() && !key.starts_with('#') && strange_.emplace(key).second) {
      const std::string shown(key.substr(0, kLongestKey));
      notes_.strangeKeys.push_back("'" + shown + (shown.size() < key.size() ? "..." : "") +
                                   "' (line " + std::to_string(number_) + ")");
    }
    write(key, rest);
  }

  // The words that must be numbers; those that are not finite are 0, with a note.
  std::vector<std::string> numbers(std::string_view key, std::span<const std::string_view> words) {
    std::vector<std::string> out;
    for (const std::string_view word : words) {
      if (word.starts_with('#')) break;
      bool finite = true;
      if (!isNumber(word, finite)) fail(key, noNumber(word));
      if (!finite) note(key, ": " + std::string(word) + " counts as 0");
      const double value = finite ? valueOf(word) : 0.0;
      if (!(std::fabs(value) <= std::numeric_limits<float>::max()))
        fail(key, std::string(word) + " is out of range: at most 3.4e38");
      const bool negative = value < 0.0 && key != "anisor" && key != "illum";
      if (negative) note(key, ": " + std::string(word) + " is negative and counts as 0");
      out.emplace_back(finite && !negative ? word : "0");
    }
    return out;
  }

  void addNumber(std::string_view key, std::string_view rest) {
    std::vector<std::string_view> words = wordsOf(rest);
    if (key == "d" && !words.empty() && words.front() == "-halo") {
      note(key, ": option -halo is ignored");
      words.erase(words.begin());
    }
    const auto values = numbers(key, std::span(words).first(std::min<size_t>(words.size(), 1)));
    if (values.empty()) fail(key, "needs a number");
    write(key, values.front());
  }

  void addColour(std::string_view key, std::string_view rest) {
    std::vector<std::string_view> words = wordsOf(rest);
    if (!words.empty() && words.front() == "spectral") {
      note(key, std::string(" spectral is ignored: ") +
                    (key == "Kd" ? "it is grey (Kd 0.5)" : "write three numbers"));
      if (key == "Kd") write(key, "0.5 0.5 0.5");
      return;
    }
    const bool xyz = !words.empty() && words.front() == "xyz";
    if (xyz) words.erase(words.begin());
    if (words.size() > 3) words.resize(3);  // what follows means nothing
    std::vector<std::string> values = numbers(key, words);
    if (values.size() == 1) values.resize(3, values.front());
    if (values.size() != 3) fail(key, "needs one number, or three");
    if (xyz) values = linearSrgb(values);
    write(key, values[0] + " " + values[1] + " " + values[2]);
  }

  // Linear sRGB from CIE XYZ (IEC 61966-2-1).
  static std::vector<std::string> linearSrgb(const std::vector<std::string>& xyz) {
    constexpr double kRgb[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
    std::array<double, 3> in{};
    for (size_t i = 0; i < 3; ++i) in[i] = valueOf(xyz[i]);
    std::vector<std::string> out;
    for (const auto& row : kRgb)
      out.push_back(shortestText(std::max(0.0, row[0] * in[0] + row[1] * in[1] + row[2] * in[2])));
    return out;
  }

  void addMap(std::string_view key, std::string_view rest) {
    const MapOptions map = mapOptions(rest);
    if (!map.problem.empty()) fail(key, map.problem);
    for (const std::string& option : map.zeroed) note(key, ": " + option + " counts as 0");
    for (const std::string& option : map.ignored)
      note(key, ": option " + option + " is not supported and is ignored");
    write(key, map.kept + map.name);
  }

  const fs::path& library_;
  MtlNotes& notes_;
  size_t number_ = 0;
  std::string material_;
  std::set<std::string, std::less<>> strange_;
  std::string text_;
};

}  // namespace

std::string plainMtl(const fs::path& library, std::string_view lines, MtlNotes& notes) {
  Lines out(library, notes);
  while (!lines.empty()) {
    const size_t end = std::min(lines.find_first_of("\r\n"), lines.size());
    out.add(lines.substr(0, end));
    const size_t length = lines.substr(end, 2) == "\r\n" ? 2 : 1;
    lines.remove_prefix(std::min(end + length, lines.size()));
  }
  return out.take();
}

}  // namespace bnvpl
