// vpl-place: places candidate VPLs where camera paths hit after their first rough bounce.
//   vpl-place scene.toml -o candidates.vpl -n 60k
#include "core/hash.h"
#include "core/memory.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/stage/stage_run.h"
#include "tools/place/cost_of_placing.h"
#include "tools/place/report.h"
#include "tools/place/views_option.h"

namespace bnvpl {
namespace {

constexpr RealOption kSpareOption = realOption(
    "shard-spare", "", 0, 10, "",
    "extra VPLs of a shard, as a fraction of its part; vpl-merge says if they are needed");

struct Request : StageRequest {
  double shardSpare = 0.0;
  std::vector<uint64_t> viewShares;
};

int runPlace(const Request& request, const ToolOptions& tool) {
  StageRun run("vpl-place", request, tool);
  const Values options = resolve(placeSpec(), request.given);
  const uint64_t count = options[kPlaceCountOption];
  const double saved = request.checkpoint.file.empty() ? 0.0 : kBytesPerSaved;
  const double rowBytes =
      request.shard ? 0.0 : (kBytesPerPlaced + saved) * static_cast<double>(count);
  run.used.reads("scene", request.scene.file);
  const PlaceMethod& method = placeMethod(options);
  run.used.writes("-o", request.output, {request.shard ? OutputKind::Shard : kindOf(method.makes)});
  run.checkFiles();
  if (!run.predictsCost())
    requireMemory(rowBytes, std::to_string(count) + " VPLs", "ask for fewer with -n");
  Scene scene = loadSceneFor(request.scene, Warnings::Hold);
  const PlaceViews views = placeViews(request.scene, request.viewShares, method, scene);
  if (method.needsLight || !scene.isToml()) scene.requireLight();
  printHeldWarnings();
  run.filesReady(scene.files);
  const Accelerator accel(scene, tool.processor);
  const LightSet lights(accel);
  const PlaceInputs inputs{accel, lights, views};
  if (run.predictsCost()) {
    return run.predictCost("VPLs placed,", [&](const ProgressFn& progress) {
      return costOfPlacing(inputs, options, progress, rowBytes);
    });
  }

  Json record = stageRecord("vpl-place", recordOf(placeSpec(), options),
                            {{"scene", hashText(scene.contentHash)}}, tool.processor);
  if (method.forView) recordViews(views, record);
  const auto whole = [&](const StageTask& task) {
    PlaceResult placed = place(inputs, options, task.progress, task.controls);
    placed.table.provenance = extendProvenance("", record);
    writeVpl(task.files.add(request.output), placed.table);
    reportPlaced(placed, task.summary);
  };
  const auto part = [&](const StageTask& task) -> ShardRun {
    reportPlaced(placeShard(inputs, options, request.shardSpare, task.controls, task.progress),
                 task.summary);
    return {record, request.given, Json::object(), request.command, ""};
  };
  return run.execute({record, "VPLs", count, scene.files, whole, part});
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  const CommandLine cli{"Place candidate VPLs on the surfaces that light the view.", "vpl-place"};
  Request request;
  ToolOptions tool;
  addSceneOptions(cli, request.scene, ViewCount::Several);
  addOption(cli, kViewSharesOption, [&request](const Value& value) {
    request.viewShares = parseViewShares(std::get<std::string>(value));
  });
  required(addFile(cli, "-o,--output", request.output, "candidates (.vpl)"));
  addStageRequest(cli, placeSpec(), request, tool, "paths");
  needing("--shard", addReal(cli, kSpareOption, request.shardSpare));
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runPlace(request, tool);
  });
}
