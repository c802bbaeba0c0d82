#include "tools/inspect/check/chain.h"

#include <algorithm>
#include <charconv>
#include <unordered_map>

#include "core/hash.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/files/shell_text.h"

namespace bnvpl {
namespace {

using Links = std::vector<const CheckedFile*>;  // sorted by length of history

bool sameRecord(const StageRecord& a, const StageRecord& b) {
  return a.tool == b.tool && a.version == b.version && a.options == b.options &&
         a.inputs == b.inputs && a.views == b.views && a.processor == b.processor;
}

std::string optionText(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_string()) return shellWord(value.get<std::string>());
  if (!value.is_number_float()) return shellWord(jsonText(value));
  char text[32];  // shortest text that parses back to this number
  const auto end = std::to_chars(text, text + sizeof text, value.get<double>());
  return {text, end.ptr};
}

bool readsScene(const StageRecord& record) { return record.inputs.count("scene") > 0; }

// The commands that rerun link `first` and all after it, each on the output of its predecessor.
std::string mending(const Links& links, size_t first, const SceneWords& words) {
  std::string commands;
  for (size_t i = first; i < links.size(); ++i) {
    if (links[i]->chain.empty()) continue;
    const StageRecord& record = links[i]->chain.back();
    std::vector<std::string> inputs;
    // The stages that always read the scene take it first; vpl-eliminate takes --scene.
    const bool leads = record.tool != "vpl-eliminate";
    std::vector<std::string> scene = words.scene;
    if (record.views.size() == 1) scene.insert(scene.end(), words.view.begin(), words.view.end());
    for (size_t v = 1; record.views.size() > 1 && v <= record.views.size(); ++v)
      scene.insert(scene.end(), {"--view", "VIEW-" + std::to_string(v) + ".toml"});
    if (readsScene(record) && leads) inputs = scene;
    if (i > 0) inputs.push_back(links[i - 1]->file.string());
    if (readsScene(record) && !leads) {
      inputs.push_back("--scene");
      inputs.insert(inputs.end(), scene.begin(), scene.end());
    }
    commands += (commands.empty() ? "" : " && ") + commandOf(record, inputs, links[i]->file) +
                links[i]->moreOptions;
  }
  return commands;
}

void requireOneOfEachStage(const Links& links) {
  for (size_t i = 1; i < links.size(); ++i) {
    if (links[i]->chain.size() == links[i - 1]->chain.size())
      throw InputError(links[i]->file, "is of the same stage as " + links[i - 1]->file.string() +
                                           "; name the files of one chain");
  }
}

// The first file must have a history of one record, and each file one more than its predecessor.
void requireNoGap(const Links& links) {
  size_t before = 0;
  for (const CheckedFile* link : links) {
    if (link->chain.empty())
      throw InputError(link->file, "has no history; make it again with the tools");
    if (link->chain.size() != before + 1) {
      std::string missing = "its input";
      for (const auto& [name, checksum] : link->chain.back().inputs) {
        if (name != "scene") missing = name + " " + checksum;
      }
      throw InputError(link->file,
                       "was made from " + missing +
                           ", which is not among the files; name that file too, or make the "
                           "chain again from vpl-place");
    }
    before = link->chain.size();
  }
}

// Describes a contradiction between the histories of two neighbours; empty if there is none.
std::string brokenHistory(const CheckedFile& earlier, const CheckedFile& later) {
  const StageRecord& record = later.chain.back();
  for (const auto& [name, checksum] : record.inputs) {
    if (name != "scene" && checksum != earlier.checksum)
      return record.tool + " read " + name + " " + checksum + ", but " + earlier.file.string() +
             " is " + earlier.checksum;
  }
  if (!std::equal(earlier.chain.begin(), earlier.chain.end(), later.chain.begin(), sameRecord))
    return "its history does not continue that of " + earlier.file.string();
  return {};
}

// Rejection divides the flux of a row by the probability that it is kept, and assigns a new radius.
bool isReweighted(std::string_view column) {
  return column == "flux" || column == "first_bounce_flux" || column == "radius";
}
bool isScaled(const VplTable& from, size_t source, const VplTable& to, size_t row) {
  constexpr float kRounding = 1e-5f;
  const float before = maxComponent(from.flux[source]), after = maxComponent(to.flux[row]);
  const float weight = before > 0.0f ? after / before : 1.0f;
  const auto scaled = [&](Vec3 a, Vec3 b) {
    return maxComponent(max(a * weight - b, b - a * weight)) <= kRounding * after;
  };
  return weight >= 1.0f - kRounding && scaled(from.flux[source], to.flux[row]) &&
         scaled(from.firstBounceFlux[source], to.firstBounceFlux[row]);
}

std::string brokenRows(const CheckedFile& earlier, const CheckedFile& later) {
  if (!earlier.stage || !later.stage) return {};
  const VplTable from = readVpl(earlier.file), to = readVpl(later.file);
  if (to.indirectShare != from.indirectShare)
    return "its share of indirect light is not that of " + earlier.file.string();
  const bool kept = to.stage == VplStage::Eliminated || to.stage == from.stage;
  const bool reweighted = kept && from.stage == VplStage::Lit;
  if (!kept && to.size() != from.size())
    return "has " + std::to_string(to.size()) + " rows, " + earlier.file.string() + " " +
           std::to_string(from.size());
  const auto before = columnsOf(from), after = columnsOf(to);
  const size_t shared = standardColumns(std::min(from.stage, to.stage)).size();
  std::unordered_map<uint32_t, size_t> rowOf;
  for (size_t row = 0; kept && row < from.size(); ++row) rowOf[from.id[row]] = row;
  for (size_t row = 0; row < to.size(); ++row) {
    const auto found = rowOf.find(to.id[row]);
    const size_t source = kept ? (found == rowOf.end() ? from.size() : found->second) : row;
    bool same = source < from.size();
    for (size_t c = 0; same && c < shared; ++c) {
      same = (reweighted && isReweighted(before[c].name)) ||
             std::ranges::equal(before[c].row(source), after[c].row(row));
    }
    if (same && reweighted) same = isScaled(from, source, to, row);
    if (same && !kept) {
      constexpr double kRounding = 1.0 + 1e-5;  // reaches are compared as squares of floats
      for (size_t k = row * to.emitPoints; k < (row + 1) * to.emitPoints; ++k)
        same = same && double{length(to.emitPosition[k] - to.position[row])} <=
                           kRounding * to.reachFactor * double{to.radius[row]};
    }
    if (!same)
      return "row " + std::to_string(row) + " (id " + std::to_string(to.id[row]) +
             ") is not that of " + earlier.file.string();
  }
  return {};
}

}  // namespace

std::string commandOf(const StageRecord& record, const std::vector<std::string>& inputs,
                      const fs::path& output) {
  // A stranger's file may hold anything, and the command is there to be pasted into a shell.
  std::string command = shellWord(record.tool);
  for (const std::string& input : inputs) command += " " + shellWord(input);
  command += " -o " + shellWord(output.string());
  for (const auto& [name, value] : record.options.items()) {
    command += " " + shellWord("--" + name) + " " + optionText(value);
  }
  if (!record.processor.empty()) command += " --processor " + shellWord(record.processor);
  return command;
}

void checkChain(std::span<const CheckedFile> files, const Scene* scene, const SceneWords& words) {
  const std::string sceneHash = scene ? hashText(scene->contentHash) : "";
  Links links;
  for (const CheckedFile& f : files) links.push_back(&f);
  std::stable_sort(links.begin(), links.end(), [](const CheckedFile* a, const CheckedFile* b) {
    return a->chain.size() < b->chain.size();
  });
  requireOneOfEachStage(links);
  requireNoGap(links);
  const std::string& version = links.front()->chain.front().version;
  for (size_t i = 0; i < links.size(); ++i) {
    const CheckedFile& link = *links[i];
    std::string broken;
    size_t first = i;  // first link to rerun
    if (!sceneHash.empty() && link.scene != sceneHash) {
      broken =
          "made from scene " + link.scene + ", but " + words.scene.front() + " is " + sceneHash;
      first = 0;
    } else {
      if (scene) broken = brokenView(link, link.chain.back(), *scene);
      if (broken.empty() && i > 0) broken = brokenHistory(*links[i - 1], link);
      if (broken.empty() && i > 0) broken = brokenRows(*links[i - 1], link);
    }
    if (broken.empty() && link.chain.back().version != version)
      broken =
          "made by version " + link.chain.back().version + ", the files before it by " + version;
    if (!broken.empty())
      throw InputError(link.file, broken + "; run: " + mending(links, first, words));
  }
}

}  // namespace bnvpl
