#include "tools/common/stage/shard_info.h"

#include "formats/provenance.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

std::string textOf(const ShardParts& parts) {
  std::string text;
  for (const auto& [first, last] : parts) {
    text += (text.empty() ? "" : ", ") + std::to_string(first) +
            (last > first ? "-" + std::to_string(last) : "");
  }
  return text;
}

std::string textOf(const ShardInfo& info) {
  return jsonText({{"run", info.run.run},
                   {"given", info.run.given},
                   {"sources", info.run.sources},
                   {"command", info.run.command},
                   {"history", info.run.history},
                   {"processor", info.processor},
                   {"parts", info.parts},
                   {"of", info.of}});
}

namespace {

ShardInfo infoOf(const Json& json) {
  return {
      {fieldOf<Json>(json, "run"), fieldOf<Given>(json, "given"), fieldOf<Json>(json, "sources"),
       fieldOf<std::string>(json, "command"), fieldOf<std::string>(json, "history")},
      fieldOf<std::string>(json, "processor"),
      fieldOf<ShardParts>(json, "parts"),
      fieldOf<uint64_t>(json, "of")};
}

}  // namespace

ShardInfo parseShardInfo(const fs::path& file, const std::string& text) {
  // The object is checked as the only one of an array: isProvenance() tests depth and UTF-8.
  const std::string list = "[" + text + "]";
  const Json all = isProvenance(list) ? parseJson(list) : Json::array();
  if (all.size() != 1)
    throw InputError(file, "is damaged (what it says of itself); delete it and make it again");
  ShardInfo info;
  try {
    info = infoOf(all.front());
  } catch (const InputError& e) {
    throw InputError(file, e.what());
  }
  const bool history = info.run.history.empty() || isProvenance(info.run.history);
  if (!history || info.parts.empty() || info.of < 1 || info.of > kMaxShards)
    throw InputError(file, "is damaged (its parts or history); delete it and make it again");
  return info;
}

}  // namespace bnvpl
