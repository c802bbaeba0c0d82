#include "scene/read/obj/mtl/map_options.h"

#include <algorithm>
#include <array>

#include "scene/read/obj/obj_syntax.h"
#include "scene/read/obj/obj_text.h"

namespace bnvpl {

namespace {

struct Option {
  std::string_view name;
  size_t least, most;          // limits on the number of values
  bool numbers;                // whether the values are numbers, else words
  std::string_view missing;    // replaces each value that is left out
  bool kept;                   // whether it is passed to tinyobjloader
  std::string_view unchanged;  // values without effect
};
constexpr std::array<Option, 15> kOptions{{
    {"-s", 1, 3, true, " 1", true, ""},
    {"-o", 1, 3, true, " 0", true, ""},
    {"-t", 1, 3, true, " 0", false, " 0 0 0"},
    {"-bm", 1, 1, true, "", true, ""},
    {"-mm", 2, 2, true, "", false, " 0 1"},
    {"-clamp", 1, 1, false, "", false, " off"},
    {"-blendu", 1, 1, false, "", false, " on"},
    {"-blendv", 1, 1, false, "", false, " on"},
    {"-cc", 1, 1, false, "", false, " off"},
    {"-imfchan", 1, 1, false, "", false, ""},
    {"-texres", 1, 1, false, "", false, ""},
    {"-boost", 1, 1, true, "", false, ""},
    {"-type", 1, 1, false, "", false, ""},
    {"-colorspace", 1, 1, false, "", false, ""},
    {"-halo", 0, 0, false, "", false, ""},
}};

const Option* optionOf(std::string_view word) {
  const auto found = std::ranges::find(kOptions, word, &Option::name);
  return found == kOptions.end() ? nullptr : &*found;
}

using Words = std::vector<std::string_view>;

// Parses options from words[at] on and leaves at least `left` words. Returns where they end.
size_t takeOptions(const Words& words, size_t at, size_t left, MapOptions& out) {
  while (at < words.size()) {
    const Option* option = optionOf(words[at]);
    if (option == nullptr) return at;
    std::string values;
    size_t count = 0;
    bool finite = true;
    for (++at; count < option->most && at + left < words.size(); ++at, ++count) {
      if (option->numbers && !isNumber(words[at], finite)) break;
      if (!finite) out.zeroed.push_back(std::string(option->name) + " " + std::string(words[at]));
      values.append(" ").append(finite ? words[at] : "0");
    }
    if (count < option->least) {
      out.problem = "option " + std::string(option->name) + " needs " +
                    (option->numbers ? "a number" : "a word") +
                    (option->numbers && at + left < words.size() ? ": " + noNumber(words[at]) : "");
      return at;
    }
    for (; count < option->most; ++count) values += option->missing;
    if (option->kept)
      out.kept.append(option->name).append(values) += ' ';
    else if (values != option->unchanged)
      out.ignored.push_back(std::string(option->name) + values);
  }
  return at;
}

}  // namespace

MapOptions mapOptions(std::string_view rest) {
  const Words words = wordsOf(rest);
  MapOptions out;
  const size_t name = takeOptions(words, 0, 1, out);
  if (!out.problem.empty() || name >= words.size()) return out;
  size_t end = words.size();
  for (size_t i = name + 1; i < words.size() && end == words.size(); ++i) {
    MapOptions behind = out;
    if (optionOf(words[i]) == nullptr || takeOptions(words, i, 0, behind) < words.size() ||
        !behind.problem.empty())
      continue;
    out = std::move(behind);
    end = i;
  }
  const char* last = words[end - 1].data() + words[end - 1].size();
  out.name.assign(words[name].data(), last);
  return out;
}

}  // namespace bnvpl
