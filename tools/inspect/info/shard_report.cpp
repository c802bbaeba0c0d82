#include "tools/inspect/info/shard_report.h"

#include <algorithm>

#include "formats/shard/shard_file.h"
#include "tools/common/run/run_tool.h"
#include "tools/common/stage/shard_info.h"
#include "tools/inspect/append_text.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {
namespace {

// Counts units, sums and bytes of each work. Reads, and thus verifies, all blocks.
Json describeWorks(ShardReader& reader) {
  Json works = Json::array();
  for (size_t b = 0; b < reader.blocks().size(); ++b) {
    const ShardBlock& block = reader.blocks()[b];
    reader.read(b);
    auto work =
        std::ranges::find(works, Json(block.name()), [](const Json& w) { return w.at("name"); });
    if (work == works.end()) {
      works.push_back({{"name", block.name()}, {"units", 0}, {"sums", 0}, {"bytes", 0}});
      work = std::prev(works.end());
    }
    const auto add = [&](const char* key, uint64_t more) {
      (*work)[key] = (*work)[key].get<uint64_t>() + more;
    };
    if (block.kind == kShardRecord)
      add("units", 1);
    else
      add("sums", block.count);
    add("bytes", block.bytes());
  }
  return works;
}

std::string word(const Json& json, const char* key) {
  return json[key].is_string() ? json[key].get<std::string>() : jsonText(json[key]);
}

}  // namespace

Json describeShard(const fs::path& file) {
  ShardReader reader(file);
  const ShardInfo info = parseShardInfo(file, reader.info());
  const std::string history =
      info.run.history.empty() ? extendProvenance("", info.run.run) : info.run.history;
  parseProvenance(file, history);  // throws when it is damaged
  return {{"format", "shard"},
          {"version", kShardVersion},
          {"parts", textOf(info.parts)},
          {"of", info.of},
          {"stage", fieldOf<std::string>(info.run.run, "tool")},
          {"build", fieldOf<std::string>(info.run.run, "version")},
          {"processor", info.processor},
          {"command", info.run.command},
          {"provenance", parseJson(history)},
          {"works", describeWorks(reader)}};
}

std::string shardText(const Json& d) {
  std::string text;
  append(text, "%s: part %s of %s of %s, %s bytes, format version %s\n", word(d, "file").c_str(),
         word(d, "parts").c_str(), word(d, "of").c_str(), word(d, "stage").c_str(),
         word(d, "bytes").c_str(), word(d, "version").c_str());
  append(text, "  build %s, processor %s, all checksums right\n", word(d, "build").c_str(),
         word(d, "processor").c_str());
  append(text, "  command %s\n", word(d, "command").c_str());
  text += "made by:\n";
  for (const StageRecord& record : parseProvenance(word(d, "file"), jsonText(d["provenance"])))
    text += "  " + describeRecord(record) + "\n";
  append(text, "%-18s %12s %12s %12s\n", "work", "units", "sums", "bytes");
  for (const Json& work : d["works"]) {
    append(text, "  %-16s %12s %12s %12s\n", word(work, "name").c_str(),
           word(work, "units").c_str(), word(work, "sums").c_str(), word(work, "bytes").c_str());
  }
  return text;
}

}  // namespace bnvpl
