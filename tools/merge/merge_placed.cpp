#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/merge/merge.h"
#include "tools/place/place.h"
#include "tools/place/report.h"

namespace bnvpl {

namespace {

[[noreturn]] void refuseTooFew(const ShardSet& shards, uint64_t unit) {
  const uint64_t part = unit % shards.of();
  throw InputError("the shards hold too few VPLs: shard " + std::to_string(part + 1) +
                   " ended early; make it again with more, by " +
                   shards.commandFor({part, part + 1, shards.of()}, " --shard-spare 0.1"));
}

}  // namespace

std::vector<fs::path> mergePlaced(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                  Summary& summary) {
  const Values options = optionsOf(shards.whole(), placeSpec(),
                                   [](const Given& given) { return resolve(placeSpec(), given); });
  const uint64_t count = options.whole("count");
  requireMemory(kBytesPerPlaced * static_cast<double>(count), std::to_string(count) + " VPLs",
                "place fewer with -n");
  const Json& record = shards.whole().run;
  const uint64_t sceneHash = inputHash(shards.whole(), "scene");
  PlaceResult placed = joinPlaced(options, sceneHash, shards.source(),
                                  [&](uint64_t unit) { refuseTooFew(shards, unit); });
  placed.table.provenance = extendProvenance("", record);
  requireSound(placed.table);
  writeVpl(files.add(output.product), placed.table);
  reportPlaced(placed, summary);
  return {};
}

}  // namespace bnvpl
