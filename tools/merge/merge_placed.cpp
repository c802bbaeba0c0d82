#include "core/memory.h"
#include "formats/vpl/vpl_io.h"
#include "tools/merge/merge.h"
#include "tools/place/place.h"
#include "tools/place/report.h"

namespace bnvpl {

namespace {

[[noreturn]] void refuseTooFew(const ShardSet& shards, uint64_t unit) {
  const uint64_t part = unit % shards.of();
  throw InputError("the shards hold too few VPLs: shard " + std::to_string(part + 1) +
                   " ended early; make it again with more, by " +
                   shards.commandFor({part, part + 1, shards.of()}, " --shard-spare 0.5"));
}

// The shares of views as vpl-place records them; a single view has none.
ViewTurns turnsOf(const Json& record) {
  std::vector<uint64_t> shares;
  if (!record.contains("views")) return ViewTurns();
  uint64_t left = kMaxViewTurns;
  for (const Json& view : fieldOf<std::vector<Json>>(record, "views")) {
    const auto share = fieldOf<uint64_t>(view, "share");
    if (share == 0 || share > left)
      throw InputError("the shards have views of strange shares; make them again");
    left -= share;
    shares.push_back(share);
  }
  if (shares.empty()) throw InputError("the shards have no views; make them again");
  return ViewTurns(std::move(shares));
}

Values placeOptionsOf(const ShardRun& whole) {
  return optionsOf(whole, placeSpec(),
                   [](const Given& given) { return resolve(placeSpec(), given); });
}

}  // namespace

OutputKind placedKind(const ShardRun& whole) {
  return kindOf(placeMethod(placeOptionsOf(whole)).makes);
}

std::vector<fs::path> mergePlaced(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                  Summary& summary) {
  const Values options = placeOptionsOf(shards.whole());
  const uint64_t count = options[kPlaceCountOption];
  requireMemory(kBytesPerPlaced * static_cast<double>(count), std::to_string(count) + " VPLs",
                "place fewer with -n");
  const Json& record = shards.whole().run;
  const uint64_t sceneHash = inputHash(shards.whole(), "scene");
  const ViewTurns turns = turnsOf(record);
  PlaceResult placed = joinPlaced(options, sceneHash, turns, shards.source(),
                                  [&](uint64_t unit) { refuseTooFew(shards, unit); });
  placed.table.provenance = extendProvenance("", record);
  requireSound(placed.table);
  writeVpl(files.add(output.product), placed.table);
  reportPlaced(placed, summary);
  return {};
}

}  // namespace bnvpl
