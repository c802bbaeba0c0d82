// vpl-place: places candidate VPLs where camera paths hit after their first diffuse bounce.
//   vpl-place scene.toml -o candidates.vpl -n 60k
#include <CLI/CLI.hpp>
#include <cmath>

#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/cost.h"
#include "tools/common/depfile.h"
#include "tools/common/exit_codes.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/common/shard.h"
#include "tools/place/place.h"
#include "tools/place/report.h"
#include "tools/place/row_join.h"

namespace bnvpl {
namespace {

constexpr Option kSpareOption =
    realOption("shard-spare", "", 0, 10, "of its part",
               "spare VPLs that a shard places; vpl-merge says if they are needed");

constexpr Option kViewSharesOption =
    textOption("view-shares", "", "N,...",
               "relative numbers of paths for several views; equal unless given");

struct Request {
  SceneOptions scene;
  fs::path output;
  CheckpointOptions checkpoint;
  std::optional<Shard> shard;
  double shardSpare = 0.0;
  std::vector<uint64_t> viewShares;
  CostOptions cost;
  Given given;
  std::string command;  // the command line without --shard and -o
};

// Parses a list such as "2,1".
std::vector<uint64_t> parseShares(const std::string& text) {
  std::vector<uint64_t> shares;
  uint64_t all = 0;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const auto share = parseReal(text.substr(begin, end - begin));
    const bool whole =
        share && *share >= 1 && *share <= kMaxViewTurns && *share == std::floor(*share);
    all += shares.emplace_back(whole ? static_cast<uint64_t>(*share) : 0);
    if (!whole || all > kMaxViewTurns) {
      throw UsageError("--view-shares '" + text +
                       "' is not a list of whole numbers such as 2,1,1, of at most " +
                       std::to_string(kMaxViewTurns) + " together");
    }
    begin = end + 1;
  }
  return shares;
}

PlaceViews placeViews(const Request& request, const PlaceMethod& method, Scene& scene) {
  std::vector<View> views = viewsOf(request.scene, scene);
  if (views.size() > 1 && !method.forView) {
    throw UsageError("--method " + std::string(method.name) +
                     " asks for no view; leave all but one out");
  }
  std::vector<uint64_t> shares = request.viewShares;
  if (shares.empty()) shares.assign(views.size(), 1);
  if (shares.size() != views.size()) {
    throw UsageError("--view-shares has " + std::to_string(shares.size()) + " parts for " +
                     std::to_string(views.size()) + " views; give one for each --view or --camera");
  }
  if (shares.size() > kMaxViewTurns)
    throw UsageError("more than " + std::to_string(kMaxViewTurns) + " views; name fewer");
  return {std::move(views), std::move(shares)};
}

// Records the only view, or all views with their shares.
void recordViews(const PlaceViews& of, Json& record) {
  if (of.views.size() == 1) {
    record["view"] = viewRecord(of.views.front().camera, of.views.front().film);
    return;
  }
  for (size_t v = 0; v < of.views.size(); ++v) {
    Json one = viewRecord(of.views[v].camera, of.views[v].film);
    one["share"] = of.turns.shares()[v];
    record["views"].push_back(std::move(one));
  }
}

double memoryFor(const Request& request, uint64_t count) {
  return request.shard ? 0.0 : kBytesPerPlaced * static_cast<double>(count);
}

// Measures runs with fewer VPLs. The work is the number of waves, as the last wave is always traced
// whole.
Cost costOfPlacing(const PlaceInputs& inputs, const Values& options, const ProgressFn& progress) {
  constexpr uint64_t kFirst = 1 << 17;
  double paths = 0.0, besideRows = 0.0;
  const auto part = [&](uint64_t count) {
    Values some = options;
    some.set("count", count);
    const MemoryWatch memory;
    const PlaceResult placed = place(inputs, some, progress);
    paths = static_cast<double>(placed.paths) / static_cast<double>(count);
    besideRows = memory.peak() - kBytesPerPlaced * static_cast<double>(count);
  };
  Cost cost = costOfRows(options.whole("count"), kFirst, part, [&](uint64_t count) {
    const auto wave = static_cast<double>(kChunksPerWave * kPathsPerChunk);
    return std::ceil(paths * static_cast<double>(count) / wave);
  });
  cost.memoryBytes = besideRows;
  return cost;
}

int runPlace(const Request& request, const ToolOptions& tool) {
  Summary summary("vpl-place");
  const fs::path& output = request.output;
  const Values options = resolve(placeSpec(), request.given);
  const uint64_t count = options.whole("count");
  RunFiles used;
  used.reads("scene", request.scene.file);
  used.writes("-o", output, {request.shard ? OutputKind::Shard : OutputKind::Vpl});
  used.writes("--checkpoint", request.checkpoint.file).writes(tool);
  if (!request.cost.estimate) {
    used.check();
    requireMemory(memoryFor(request, count), std::to_string(count) + " VPLs",
                  "ask for fewer with -n");
  }
  Scene scene = loadSceneFor(request.scene, Warnings::Hold);
  const PlaceMethod& method = placeMethod(options);
  const PlaceViews views = placeViews(request, method, scene);
  if (method.needsLight) scene.requireLight();
  printHeldWarnings();
  if (!request.cost.estimate) used.ready(scene.files);
  const RayScene rays(scene, tool.processor);
  const LightSet lights(rays);
  const PlaceInputs inputs{rays, lights, views};
  if (request.cost.estimate) {
    ProgressMeter meter("estimate: VPLs placed,", 0, tool.quiet);
    Cost cost = costOfPlacing(inputs, options, meter.callback()).ofShard(request.shard);
    cost.memoryBytes += memoryFor(request, count);
    printCost(cost, request.cost);
    return kExitOk;
  }

  Json record = stageRecord("vpl-place", recordOf(placeSpec(), options),
                            {{"scene", hashText(scene.contentHash)}}, tool.processor);
  if (method.forView) recordViews(views, record);
  Checkpoint checkpoint(request.checkpoint, withShard(record, request.shard));
  OutputSet files;
  if (request.shard) {
    ProgressMeter meter("VPLs", request.shard->shareOf(count), tool.quiet);
    ShardOutput shard(files.add(output), *request.shard);
    reportPlaced(placeShard(inputs, options, request.shardSpare, shard.only(checkpoint.resume()),
                            meter.callback()),
                 summary);
    shard.finish({record, request.given, Json::object(), request.command, ""}, summary);
  } else {
    ProgressMeter meter("VPLs", count, tool.quiet);
    PlaceResult placed = place(inputs, options, meter.callback(), checkpoint.resume());
    placed.table.provenance = extendProvenance("", record);
    writeVpl(files.add(output), placed.table);
    reportPlaced(placed, summary);
  }
  addDepfile(files, tool.depfile, output, scene.files);
  summary.finish(tool, files);
  checkpoint.remove();
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Drop candidate VPLs on the surfaces that light the view.", "vpl-place"};
  Request request;
  ToolOptions tool;
  addSceneOptions(cli, request.scene, ViewCount::Several);
  addOption(cli, kViewSharesOption, [&request](const Value& value) {
    request.viewShares = parseShares(std::get<std::string>(value));
  });
  addFile(cli, "-o,--output", request.output, "candidates (.vpl)")->required();
  addStageOptions(cli, placeSpec(), request.given);
  addCheckpointOptions(cli, request.checkpoint);
  addReal(cli, kSpareOption, request.shardSpare)
      ->needs(addShardOption(cli, request.shard, "paths"));
  addCostOptions(cli, request.cost);
  addToolOptions(cli, tool);
  addProcessorOption(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runPlace(request, tool);
  });
}
