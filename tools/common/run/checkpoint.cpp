#include "tools/common/run/checkpoint.h"

#include <CLI/CLI.hpp>

#include "formats/output_target.h"
#include "formats/shard/checkpoint.h"
#include "tools/common/options/help.h"
#include "tools/common/process/clock.h"
#include "tools/common/run/processor_id.h"

namespace bnvpl {
namespace {

// Describes the first difference between two values that stand at `path`.
std::string difference(const Json& before, const Json& now, const std::string& path) {
  if (before.is_array() && now.is_array()) {
    if (before.size() != now.size()) {
      return path + " had " + std::to_string(before.size()) + " entries and has now " +
             std::to_string(now.size());
    }
    for (size_t i = 0; i < now.size(); ++i) {
      if (before[i] != now[i])
        return difference(before[i], now[i], path + " " + std::to_string(i + 1));
    }
  }
  const auto named = [](const Json& value) { return value.is_null() ? "absent" : jsonText(value); };
  if (!before.is_object() || !now.is_object())
    return path + " was " + named(before) + " and is now " + named(now);
  const auto differing = [&](const std::string& key) {
    return before.value(key, Json()) != now.value(key, Json());
  };
  const auto describe = [&](const std::string& key) {
    return difference(before.value(key, Json()), now.value(key, Json()),
                      path.empty() ? key : path + " " + key);
  };
  for (const auto& [key, value] : now.items()) {
    if (differing(key)) return describe(key);
  }
  for (const auto& [key, value] : before.items()) {
    if (differing(key)) return describe(key);
  }
  return path;
}

// Returns the state in `file`, empty if there is none. Throws InputError if the file belongs to
// another run, with `cure`.
std::string stateIn(const fs::path& file, const Json& run, const std::string& cure) {
  std::optional<CheckpointFile> found = findCheckpoint(file);
  if (!found) return "";  // another run of the command has just ended
  const Json theirs = parseJson(found->run);
  if (theirs != run) {
    throw InputError(file,
                     "is the checkpoint of another run (" + differenceOf(theirs, run) + ")" + cure);
  }
  return std::move(found->state);
}

}  // namespace

std::string differenceOf(const Json& before, const Json& now) {
  return difference(before, now, "");
}

void addCheckpointOptions(CLI::App& cli, CheckpointOptions& options) {
  CLI::Option* file = inTopic(
      Topic::Files,
      addFile(cli, "--checkpoint", options.file,
              "save progress to this file periodically, and resume from it if it exists; removed "
              "once the output is written"));
  addReal(cli, realOption("checkpoint-every", "", 0, 1e6, "", "seconds between two saves"),
          options.everyS)
      ->needs(file);
  inTopic(Topic::Expert,
          cli.add_flag("--checkpoint-replace", options.replace,
                       "start over if the checkpoint is damaged or belongs to another run"))
      ->needs(file);
}

Checkpoint::Checkpoint(CheckpointOptions options, Json run)
    : options_(std::move(options)), run_(std::move(run)), nextS_(nowS() + options_.everyS) {
  if (options_.file.empty()) return;
  requireWritable({options_.file});
  run_["processor_id"] = processorId(processorOf(run_));
  try {
    earlier_ = stateIn(options_.file, run_,
                       options_.replace ? ""
                                        : "; repeat that run's command, name another file, or add "
                                          "--checkpoint-replace");
  } catch (const InputError& unusable) {
    if (!options_.replace || !beginsAsCheckpoint(options_.file).value_or(false)) throw;
    warnAsAsked(std::string(unusable.what()) + "; the work begins anew");
  }
}

WorkControls Checkpoint::controls() {
  if (options_.file.empty()) return {};
  defer_.emplace();
  return {std::move(earlier_), [this] { return due(); },
          [this](const std::string& state) { save(state); }};
}

bool Checkpoint::due() const { return interrupted() || nowS() >= nextS_; }

void Checkpoint::save(const std::string& state) {
  const bool last = interrupted();
  if (!beginsAsCheckpoint(options_.file).value_or(true)) {
    throw OutputError(options_.file,
                      "is no checkpoint any more: somebody else wrote to it; name another file");
  }
  writeCheckpoint(options_.file, {jsonText(run_), state});
  if (last) throw Interrupted("the same command goes on from " + options_.file.string());
  nextS_ = nowS() + options_.everyS;
}

void Checkpoint::remove() {
  std::error_code ignored;
  if (beginsAsCheckpoint(options_.file).value_or(false))
    fs::remove(followLinks(options_.file), ignored);
  defer_.reset();
}

}  // namespace bnvpl
