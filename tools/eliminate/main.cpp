// vpl-eliminate: keeps the COUNT candidates that are spread best.
//   vpl-eliminate candidates.vpl -o vpls.vpl -n 3k
#include <optional>

#include "core/hash.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/process/memory.h"
#include "tools/common/stage/stage_run.h"
#include "tools/eliminate/cost_of_eliminating.h"
#include "tools/eliminate/report.h"

namespace bnvpl {
namespace {

// The scene, for methods that need it.
struct World {
  World(const SceneOptions& options, Processor processor, const fs::path& input, uint64_t hash)
      : scene(loadSceneFor(options, Warnings::Hold)), accel(scene, processor), lights(accel) {
    requireSameScene(input, hash, scene, "name the scene that it was placed in");
  }
  Scene scene;
  Accelerator accel;
  LightSet lights;
};

int runEliminate(const StageRequest& request, const fs::path& input, const ToolOptions& tool) {
  StageRun run("vpl-eliminate", request, tool);
  const Values options = resolve(eliminateSpec(), request.given);
  const EliminateMethod& method = eliminateMethod(options);
  requireSceneAsNeeded(method, !request.scene.file.empty());
  run.used.reads("candidates", input).reads("--scene", request.scene.file);
  const bool lit = method.takes == VplStage::Lit;
  run.used.writes("-o", request.output, {lit ? OutputKind::Lit : OutputKind::Eliminated});
  run.checkFiles();
  if (!run.predictsCost())
    requireMemoryFor(input, method.bytesPerCandidate, "place fewer with vpl-place -n");
  const VplTable candidates = readVpl(input, method.takes, method.madeBy);
  std::optional<World> world;
  if (!request.scene.file.empty())
    world.emplace(request.scene, tool.processor, input, candidates.sceneHash);
  const Accelerator* accel = world ? &world->accel : nullptr;
  const LightSet* lights = world ? &world->lights : nullptr;
  if (run.predictsCost()) {
    return run.predictCost("candidates,", [&](const ProgressFn& progress) {
      return withFile(
          input, [&] { return costOfEliminating(candidates, options, accel, lights, progress); });
    });
  }
  std::vector<fs::path> read = world ? world->scene.files : std::vector<fs::path>{};
  run.filesReady(read);
  read.insert(read.begin(), input);
  Json inputs{{"candidates", hashText(candidates.checksum)}};
  if (world) inputs["scene"] = hashText(world->scene.contentHash);
  Json record =
      stageRecord("vpl-eliminate", recordOf(eliminateSpec(), options), inputs, tool.processor);
  if (world) record["view"] = viewRecord(world->scene);
  const auto whole = [&](const StageTask& task) {
    VplTable kept = withFile(
        input, [&] { return eliminate(candidates, options, accel, lights, task.progress); });
    kept.provenance = extendProvenance(candidates.provenance, record);
    writeVpl(task.files.add(request.output), kept);
    reportEliminated(kept, candidates.size(), task.summary);
  };
  return run.execute({record, "candidates", candidates.size(), read, whole});
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  const CommandLine cli{"Keep the candidates that are spread best over the surfaces.",
                        "vpl-eliminate"};
  StageRequest request;
  ToolOptions tool;
  fs::path input;
  required(addFile(cli, "candidates", input, "from vpl-place (.vpl)"));
  required(addFile(cli, "-o,--output", request.output, "VPLs without flux (.vpl)"));
  addSceneFlag(cli, request.scene, "the scene, for methods that ask for it");
  addStageRequest(cli, eliminateSpec(), request, tool);
  return runTool(cli, tool, argc, argv, [&] { return runEliminate(request, input, tool); });
}
