#include "tools/common/stage/shard.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "tools/common/files/escape_text.h"
#include "tools/common/files/shell_text.h"
#include "tools/common/options/help.h"
#include "tools/common/run/processor_id.h"

namespace bnvpl {
namespace {

// Options that do not affect the result, all flags among them, or that each shard has for itself.
constexpr std::array<std::string_view, 15> kOwn{
    "--output",  "--shard",   "--checkpoint",  "--checkpoint-every", "--checkpoint-replace",
    "--threads", "--quiet",   "--strict",      "--no-clobber",       "--progress",
    "--stats",   "--depfile", "--shard-spare", "--estimate",         "--json"};

// Parses a number from 1 to kMaxShards, digits only; returns 0 for anything else.
uint64_t numberOf(const std::string& text) {
  const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
  if (text.empty() || text.size() > 7 || !digits) return 0;
  const uint64_t value = std::stoull(text);
  return value > kMaxShards ? 0 : value;
}

Shard parseShard(const std::string& text) {
  const size_t slash = std::min(text.find('/'), text.size());
  const std::string range = text.substr(0, slash), of = text.substr(slash);
  const size_t dash = range.find('-');
  const uint64_t first = numberOf(range.substr(0, dash));
  const uint64_t last = dash == std::string::npos ? first : numberOf(range.substr(dash + 1));
  const uint64_t all = of.empty() ? 0 : numberOf(of.substr(1));
  if (first == 0 || last < first || all < last) {
    throw UsageError("--shard '" + text + "' is not a part of so many, such as 3/64 or 3-6/64, " +
                     "of at most " + std::to_string(kMaxShards));
  }
  return {first - 1, last, all};
}

std::string nameOf(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

}  // namespace

CLI::Option* addShardOption(CLI::App& cli, std::optional<Shard>& shard, const std::string& units) {
  return inTopic(Topic::Expert,
                 cli.add_option_function<std::string>(
                     "--shard", [&shard](const std::string& text) { shard = parseShard(text); },
                     "do only this part of the " + units +
                         " and write a .shard for vpl-merge: 3/64 is the third of "
                         "64 parts, 3-6/64 are four"))
      ->type_name("I/N");
}

std::string textOf(const Shard& shard) {
  const std::string last = shard.parts() > 1 ? "-" + std::to_string(shard.end) : "";
  return std::to_string(shard.first + 1) + last + "/" + std::to_string(shard.of);
}

Json withShard(Json run, const std::optional<Shard>& shard) {
  if (shard) run["shard"] = textOf(*shard);
  return run;
}

std::string commandOf(const CLI::App& cli) {
  const bool recorded = cli.get_option("--shard")->count() > 0;
  std::string command = cli.get_name();
  for (const CLI::Option* option : cli.get_options()) {
    const std::string name = nameOf(*option);
    if (option->count() == 0 || std::ranges::find(kOwn, name) != kOwn.end()) continue;
    for (const std::string& text : option->results()) {
      if (recorded && !isUtf8(text)) {
        throw UsageError(name + " '" + text +
                         "' is no UTF-8, in which a shard records its command; rename it");
      }
      command += (option->get_positional() ? " " : " " + name + " ") + shellWord(text);
    }
  }
  return command;
}

ShardOutput::ShardOutput(AtomicFile& file, const Shard& shard)
    : writer_(file),
      shard_(shard),
      sink_{[this](std::string_view work, uint64_t unit, std::string_view bytes) {
              writer_.record(work, unit, bytes);
            },
            [this](std::string_view work, std::span<const int64_t> sums) {
              writer_.sums(work, sums);
            }} {}

WorkControls ShardOutput::only(WorkControls whole) const {
  whole.shard = shard_;
  whole.sink = &sink_;
  return whole;
}

void ShardOutput::finish(const ShardRun& run, Summary& summary) {
  writer_.finish(textOf(ShardInfo{
      run, processorId(processorOf(run.run)), {{shard_.first + 1, shard_.end}}, shard_.of}));
  summary.add("shard", textOf(shard_), "shard " + textOf(shard_) + ", for vpl-merge");
}

}  // namespace bnvpl
