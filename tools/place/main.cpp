// vpl-place: drop candidate VPLs where camera paths hit after their first diffuse bounce.
//   vpl-place scene.toml -o candidates.vpl -n 60k
#include "core/memory.h"
#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/exit_codes.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/common/shard.h"
#include "tools/place/place.h"
#include "tools/place/report.h"

namespace bnvpl {
namespace {

constexpr Option kSpareOption =
    realOption("shard-spare", "", 0, 10, "of its part",
               "VPLs that a shard places besides; vpl-merge tells where it takes any");

struct Request {
  SceneOptions scene;
  fs::path output;
  CheckpointOptions checkpoint;
  std::optional<Shard> shard;
  double shardSpare = 0.0;
  Given given;
  std::string command;  // without --shard and -o
};

double memoryFor(const Request& request, uint64_t count) {
  return request.shard ? 0.0 : kBytesPerPlaced * static_cast<double>(count);
}

int runPlace(const Request& request, const ToolOptions& tool) {
  Summary summary("vpl-place");
  const fs::path& output = request.output;
  const Values options = resolve(placeSpec(), request.given);
  const uint64_t count = options.whole("count");
  RunFiles used;
  used.reads("scene", request.scene.file);
  used.writes("-o", output, {request.shard ? kShardExtension : ".vpl"});
  used.writes("--checkpoint", request.checkpoint.file).writes(tool).check();
  requireMemory(memoryFor(request, count), std::to_string(count) + " VPLs",
                "ask for fewer with -n");
  const Scene scene = loadSceneFor("vpl-place", request.scene, Warnings::Silent);
  if (placeMethod(options).needsLight) scene.requireLight();
  printWarnings("vpl-place", scene.warnings);
  used.ready(scene.files);
  const RayScene rays(scene);
  const LightSet lights(rays);

  Json record = stageRecord("vpl-place", recordOf(placeSpec(), options),
                            {{"scene", hashText(scene.contentHash)}});
  if (placeMethod(options).forView) record["view"] = viewRecord(scene);
  Checkpoint checkpoint(request.checkpoint, withShard(record, request.shard));
  OutputSet files;
  if (request.shard) {
    ProgressMeter meter("VPLs", request.shard->shareOf(count), tool.quiet);
    ShardOutput shard(files.add(output), *request.shard);
    reportPlaced(placeShard(rays, lights, options, request.shardSpare,
                            shard.only(checkpoint.resume()), meter.callback()),
                 summary);
    shard.finish({record, request.given, Json::object(), request.command, ""}, summary);
  } else {
    ProgressMeter meter("VPLs", count, tool.quiet);
    PlaceResult placed = place(rays, lights, options, meter.callback(), checkpoint.resume());
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
  addSceneOptions(cli, request.scene);
  addFile(cli, "-o,--output", request.output, "candidates (.vpl)")->required();
  addStageOptions(cli, placeSpec(), request.given);
  addCheckpointOptions(cli, request.checkpoint);
  addReal(cli, kSpareOption, request.shardSpare)
      ->needs(addShardOption(cli, request.shard, "paths"));
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runPlace(request, tool);
  });
}
