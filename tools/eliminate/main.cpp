// vpl-eliminate: keeps the COUNT candidates that are spread best.
//   vpl-eliminate candidates.vpl -o vpls.vpl -n 3k
#include <CLI/CLI.hpp>
#include <optional>

#include "formats/vpl_io.h"
#include "tools/common/cost.h"
#include "tools/common/depfile.h"
#include "tools/common/exit_codes.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/run_files.h"
#include "tools/common/scene_options.h"
#include "tools/eliminate/eliminate.h"

namespace bnvpl {
namespace {

constexpr double kBytesPerCandidate = 120;  // measured: 140 to 150
constexpr double kBytesPerRow = 3 * sizeof(Vec3) + sizeof(uint32_t);

struct Paths {
  fs::path input, output;
  SceneOptions scene;
};

// The scene, for methods that need it.
struct World {
  World(const SceneOptions& options, Processor processor, const fs::path& input, uint64_t hash)
      : scene(loadSceneFor(options, Warnings::Hold)), rays(scene, processor), lights(rays) {
    requireSameScene(input, hash, scene, "name the scene that it was placed in");
  }
  Scene scene;
  RayScene rays;
  LightSet lights;
};

void report(const EliminateResult& kept, size_t candidates, Summary& summary) {
  summary.add("candidates", candidates);
  summary.add("kept", kept.table.size(),
              "kept " + std::to_string(kept.table.size()) + " of " + std::to_string(candidates) +
                  " candidates");
  summary.add("area", kept.area);
  summary.add("r_max", kept.rMax,
              "area " + formatSi(kept.area) + ", r_max " + formatSi(kept.rMax) + " (scene units)");
}

// Measures runs on evenly spaced subsets of the candidates, of which the same share is kept. The
// time is proportional to the number of candidates.
Cost costOfEliminating(const VplTable& candidates, const Values& options, const World* world,
                       const ProgressFn& progress) {
  constexpr uint64_t kFirst = 1 << 14, kFewPoints = 400;
  const RayScene* rays = world ? &world->rays : nullptr;
  const LightSet* lights = world ? &world->lights : nullptr;
  if (candidates.size() < options.whole("count"))
    eliminate(candidates, options, rays, lights);  // throws
  // The time is proportional to the number of camera points, too.
  const uint64_t points = options.has("camera-points") ? options.whole("camera-points") : 0,
                 judges = std::min(points, kFewPoints);
  const auto part = [&](uint64_t count) {
    std::vector<uint32_t> rows(count);
    for (uint64_t i = 0; i < count; ++i)
      rows[i] = static_cast<uint32_t>(i * candidates.size() / count);
    Values some = options;
    some.set("count", std::max<uint64_t>(1, options.whole("count") * count / candidates.size()));
    if (points > 0) some.set("camera-points", judges);
    eliminate(keepRows(candidates, rows), some, rays, lights, progress);
  };
  Cost cost = costOfRows(candidates.size(), kFirst, part,
                         [](uint64_t rows) { return static_cast<double>(rows); });
  if (points > 0) cost.workCpuS *= static_cast<double>(points) / static_cast<double>(judges);
  cost.memoryBytes -= kBytesPerRow * static_cast<double>(candidates.size());  // the subset's copy
  return cost;
}

int runEliminate(const Paths& paths, const Given& given, const CostOptions& cost,
                 const ToolOptions& tool) {
  Summary summary("vpl-eliminate");
  const Values options = resolve(eliminateSpec(), given);
  const EliminateMethod& method = eliminateMethod(options);
  const bool sceneGiven = !paths.scene.file.empty();
  if (method.needsScene != sceneGiven) {
    throw UsageError("--method " + std::string(method.name) +
                     (sceneGiven ? " takes no scene; leave --scene out"
                                 : " needs the scene; add --scene SCENE"));
  }
  RunFiles used;
  used.reads("candidates", paths.input).reads("--scene", paths.scene.file);
  used.writes("-o", paths.output, {OutputKind::Vpl}).writes(tool);
  if (!cost.estimate) {
    used.check();
    requireMemoryFor(paths.input, kBytesPerCandidate, "place fewer with vpl-place -n");
  }
  const VplTable candidates = readVpl(paths.input, method.takes);
  std::optional<World> world;
  if (sceneGiven) world.emplace(paths.scene, tool.processor, paths.input, candidates.sceneHash);
  if (cost.estimate) {
    ProgressMeter meter("estimate: candidates,", 0, tool.quiet);
    printCost(costOfEliminating(candidates, options, world ? &*world : nullptr, meter.callback()),
              cost);
    return kExitOk;
  }
  used.ready(world ? world->scene.files : std::vector<fs::path>{});

  ProgressMeter meter("candidates", candidates.size(), tool.quiet);
  EliminateResult kept = eliminate(candidates, options, world ? &world->rays : nullptr,
                                   world ? &world->lights : nullptr, meter.callback());

  Json inputs{{"candidates", hashText(candidates.checksum)}};
  if (world) inputs["scene"] = hashText(world->scene.contentHash);
  Json record =
      stageRecord("vpl-eliminate", recordOf(eliminateSpec(), options), inputs, tool.processor);
  if (world) record["view"] = viewRecord(world->scene);
  kept.table.provenance = extendProvenance(candidates.provenance, record);
  OutputSet files;
  writeVpl(files.add(paths.output), kept.table);
  std::vector<fs::path> read{paths.input};
  if (world) read.insert(read.end(), world->scene.files.begin(), world->scene.files.end());
  addDepfile(files, tool.depfile, paths.output, read);
  report(kept, candidates.size(), summary);
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Keep the candidates that are spread best over the surfaces.", "vpl-eliminate"};
  Given given;
  CostOptions cost;
  ToolOptions tool;
  Paths paths;
  addFile(cli, "candidates", paths.input, "from vpl-place (.vpl)")->required();
  addFile(cli, "-o,--output", paths.output, "VPLs without flux (.vpl)")->required();
  addSceneFlag(cli, paths.scene, "the scene, for methods that need it");
  addStageOptions(cli, eliminateSpec(), given);
  addCostOptions(cli, cost);
  addToolOptions(cli, tool);
  addProcessorOption(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runEliminate(paths, given, cost, tool); });
}
