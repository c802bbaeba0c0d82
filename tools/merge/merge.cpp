#include "tools/merge/merge.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/hash.h"
#include "formats/vpl/vpl_layout.h"

namespace bnvpl {

const MergeStage& mergeStageOf(const ShardSet& shards) {
  static constexpr std::array kStages{
      MergeStage{"vpl-place", placedKind, mergePlaced},
      MergeStage{"vpl-estimate", [](const ShardRun&) { return OutputKind::Lit; }, mergeEstimated},
      MergeStage{"vpl-render", [](const ShardRun&) { return OutputKind::Exr; }, mergeRendered,
                 true}};
  const std::string tool = fieldOf<std::string>(shards.whole().run, "tool");
  const auto found = std::ranges::find(kStages, tool, &MergeStage::tool);
  if (found == kStages.end())
    throw InputError("shards of " + tool + " cannot be merged; name those of another stage");
  return *found;
}

Values optionsOf(const ShardRun& whole, const StageSpec& spec, Values (*resolved)(const Given&)) {
  Values options;
  try {
    options = resolved(whole.given);
  } catch (const UsageError& e) {
    throw InputError("the shards have options that mean nothing (" + std::string(e.what()) +
                     "); make them again");
  }
  if (recordOf(spec, options) != fieldOf<Json>(whole.run, "options"))
    throw InputError("the shards have other options than their record; make them again");
  return options;
}

uint64_t inputHash(const ShardRun& whole, const char* name) {
  const std::string text = fieldOf<std::string>(fieldOf<Json>(whole.run, "inputs"), name);
  uint64_t hash = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (end.ec != std::errc{} || hashText(hash) != text)
    throw InputError("the shards name no hash of their " + std::string(name) + "; make them again");
  return hash;
}

void requireSameInput(const fs::path& file, uint64_t hash, const ShardRun& whole,
                      const char* name) {
  const uint64_t made = inputHash(whole, name);
  if (hash == made) return;
  throw InputError(file, "has changed since the shards were made from it (content " +
                             hashText(made) + ", now " + hashText(hash) +
                             "); put it back, or make them again");
}

void requireSound(const VplTable& table) {
  if (const auto bad = findBadValue(table)) {
    throw InputError("the shards hold values that no stage makes (row " + std::to_string(bad->row) +
                     ": " + bad->problem + "); make them again");
  }
}

}  // namespace bnvpl
