// Numbers of the command line: counts, sizes, exposures, and what CLI11 reads into options.
//
// Each line of the input is an argument.
#include <cmath>
#include <sstream>

#include "fuzz/fuzz.h"
#include "tools/common/choice.h"
#include "tools/common/exposure.h"
#include "tools/common/film_size.h"
#include "tools/common/run_tool.h"

namespace bnvpl {
namespace {

void parseAlone(const std::string& text) {
  uint64_t count = 0;
  if (accepted<UsageError>([&] { count = parseCount(text); })) {
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

// Options of every kind that the tools have.
void parseTogether(const std::vector<std::string>& arguments) {
  ToolOptions tool;
  uint64_t count = 1, seed = 1;
  unsigned bounces = 1;
  float radius = 1.0f;
  double share = 0.5;
  bool recentre = true;
  std::vector<std::string> layers;

  CLI::App cli{"fuzz", "fuzz"};
  addToolOptions(cli, tool);
  addCount(cli, "-n,--count", count, "");
  cli.add_option("--seed", seed, "");
  cli.add_option("--bounces", bounces, "")->check(inRange(0, 1000));
  cli.add_option("--radius", radius, "")->check(inRange(0.01f, 100.0f));
  cli.add_option("--share", share, "")->check(inRange(0.0, 1.0));
  addChoice(cli, "--recentre", recentre, kOnOff, "");
  cli.add_option("--layers", layers, "")->delimiter(',');

  std::vector<const char*> argv{"fuzz"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  try {
    cli.parse(static_cast<int>(argv.size()), argv.data());
  } catch (const CLI::ParseError&) {  // --help is one too
    return;
  }
  require(count >= 1 && count <= uint64_t{1} << 53, "counts are from 1 to 2^53");
  require(bounces <= 1000, "whole numbers are in range");
  require(radius >= 0.01f && radius <= 100.0f, "floats are in range");
  require(share >= 0.0 && share <= 1.0, "doubles are in range");
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
