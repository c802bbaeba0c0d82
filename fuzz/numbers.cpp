// Numbers of the command line: counts, sizes, exposures, and options read by CLI11. Each line of
// the input is an argument.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <sstream>

#include "fuzz/fuzz.h"
#include "tools/common/options/exposure.h"
#include "tools/common/options/film_size.h"
#include "tools/common/options/stage_cli.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {
namespace {

void parseAlone(const std::string& text) {
  constexpr Option kCount = countOption("count", "1", 0x1p53, "", "help");
  uint64_t count = 0;
  if (accepted<UsageError>([&] { count = std::get<uint64_t>(parseValue(kCount, text)); })) {
    require(count >= 1 && count <= uint64_t{1} << 53, "counts are from 1 to 2^53");
  }
  Film film;
  if (accepted<UsageError>([&] { film = parseSize(text); })) {
    require(film.width >= 1 && film.height >= 1 && film.width <= kMaxFilmSide &&
                film.height <= kMaxFilmSide,
            "sides are from 1 to kMaxFilmSide");
  }
  std::optional<double> ev;
  if (accepted<UsageError>([&] { ev = parseExposure(text); }) && ev) {
    require(std::fabs(*ev) <= kMaxEv, "exposures are within 64 stops");
  }
  std::optional<std::array<double, 2>> range;
  if (accepted<UsageError>([&] { range = parseExposureRange(text); }) && range) {
    require((*range)[0] <= (*range)[1] && (*range)[0] >= -kMaxEv && (*range)[1] <= kMaxEv,
            "ranges of exposures go up, within 64 stops");
  }
}

// Options of all kinds that the stages have.
constexpr auto kCountOption = letterFor("-n", countOption("count", "1", 0x1p53, "", "help"));
constexpr auto kRecentreOption = switchOption("recentre", "on", "help");
constexpr auto kStageOptions =
    optionTable(kCountOption, kSeedOption, kRecentreOption, textOption("layers", "", "", "help"));
constexpr auto kBouncesOption = wholeOption("bounces", "1", 0, 1000, "", "help");
constexpr auto kRadiusOption =
    neededBy({Condition{"recentre", "on"}}, realOption("radius", "1", 0.01, 100, "", "help"));
constexpr auto kMethodOptions = optionTable(
    kBouncesOption, kRadiusOption, choiceOption("density", "local", "local|uniform", "help"));

void parseTogether(const std::vector<std::string>& arguments) {
  static const StageSpec spec{
      "fuzz", kStageOptions, {{"method", "a", "help", {{"a", "", kMethodOptions}, {"b", "", {}}}}}};
  ToolOptions tool;
  Given given;
  CLI::App cli{"fuzz", "fuzz"};
  addToolOptions(cli, tool);
  addStageOptions(cli, spec, given);

  std::vector<const char*> argv{"fuzz"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  try {
    cli.parse(static_cast<int>(argv.size()), argv.data());
  } catch (const CLI::ParseError&) {  // also thrown by --help
    return;
  } catch (const UsageError&) {  // an invalid number of threads
    return;
  }
  Values values;
  if (!accepted<UsageError>([&] { values = resolve(spec, given); })) return;
  require(values[kCountOption] >= 1 && values[kCountOption] <= uint64_t{1} << 53,
          "counts are from 1 to 2^53");
  if (values[OptionKey<std::string>{"method"}] == "b") {
    require(!values.has(kBouncesOption), "options of another method are refused");
    return;
  }
  require(values[kBouncesOption] <= 1000, "whole numbers are in range");
  require(values.has(kRadiusOption) == values[kRecentreOption], "an option needs what it needs");
  if (!values.has(kRadiusOption)) return;
  require(values[kRadiusOption] >= 0.01 && values[kRadiusOption] <= 100.0, "numbers are in range");
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  std::istringstream input(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> arguments;
  for (std::string line; std::getline(input, line);) {
    arguments.emplace_back(line.c_str());  // a zero byte ends an argument
    parseAlone(arguments.back());
  }
  parseTogether(arguments);
  return 0;
}
