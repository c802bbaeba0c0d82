#include "formats/vpl/vpl_io.h"
#include "tools/common/process/memory.h"
#include "tools/common/stage/scene_options.h"
#include "tools/estimate/memory_of_sums.h"
#include "tools/estimate/report.h"
#include "tools/merge/merge.h"

namespace bnvpl {

namespace {

// The scene of the run. Options that it does not take any more are a change of its file.
Scene sceneOf(const ShardRun& whole) {
  const SceneOptions options = sceneOptionsOf(fieldOf<Json>(whole.sources, "scene"));
  try {
    return loadSceneFor(options, Warnings::Hold);
  } catch (const UsageError& e) {
    throw InputError(options.file, "has changed since the shards were made from it (" +
                                       std::string(e.what()) +
                                       "); put it back, or make them again");
  }
}

}  // namespace

std::vector<fs::path> mergeEstimated(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                     Summary& summary) {
  const ShardRun& whole = shards.whole();
  const Values options = optionsOf(
      whole, estimateSpec(), [](const Given& given) { return resolve(estimateSpec(), given); });
  const fs::path input = fieldOf<std::string>(whole.sources, "vpls");
  requireMemoryFor(input, bytesPerEstimated(options, 0.0), "keep fewer with vpl-eliminate -n");
  const VplTable vpls = readVpl(input, VplStage::Eliminated);
  const Scene scene = sceneOf(whole);
  requireSameInput(input, vpls.checksum, whole, "vpls");
  requireSameInput(scene.name(), scene.contentHash, whole, "scene");
  const Accelerator accel(scene, processorOf(whole.run));
  const LightSet lights(accel);
  const ShardSource source = shards.source();
  WorkControls controls;
  controls.source = &source;
  EstimateResult result = estimate(vpls, accel, lights, options, {}, controls);
  result.table.provenance = extendProvenance(vpls.provenance, whole.run);
  requireSound(result.table);
  writeVpl(files.add(output.product), result.table);
  reportEstimate(result, summary);
  std::vector<fs::path> read = scene.files;
  read.push_back(input);
  return read;
}

}  // namespace bnvpl
