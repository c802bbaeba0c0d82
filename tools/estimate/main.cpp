// vpl-estimate: photons from the real lights give the VPLs their flux.
//   vpl-estimate scene.toml vpls.vpl -o lit.vpl --photons 10M
#include <algorithm>
#include <cstdio>

#include "formats/vpl_io.h"
#include "tools/common/checkpoint.h"
#include "tools/common/choice.h"
#include "tools/common/memory.h"
#include "tools/common/progress_meter.h"
#include "tools/common/scene_options.h"
#include "tools/estimate/estimate.h"

namespace bnvpl {
namespace {

constexpr double kBytesPerVpl = 400;  // measured: 600, and a VplSum (88) a thread

const Choices<Scatter> kScatters{{"guarded", Scatter::Guarded}, {"even", Scatter::Even}};

Json describe(const EstimateOptions& o) {
  return {{"photons", o.photons},
          {"radius", o.radius},
          {"scatter", nameOf(o.scatter, kScatters)},
          {"max-bounces", o.maxBounces},
          {"recentre", o.recentre},
          {"seed", o.seed}};
}

float medianError(const VplTable& vpls) {
  std::vector<float> errors;
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (vpls.photons[i] > 0) errors.push_back(vpls.relativeError[i]);
  }
  if (errors.empty()) return 0.0f;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

void report(const EnergyAccount& a, const VplTable& vpls, Summary& summary) {
  const auto percent = [](double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
  };
  char line[256];
  std::snprintf(line, sizeof line,
                "%s photons, %s hits: emitted %.4g W, escaped %.1f %%, absorbed %.1f %%",
                formatSi(double(a.photons)).c_str(), formatSi(double(a.hits)).c_str(), a.emitted,
                percent(a.escaped, a.emitted), percent(a.absorbed, a.emitted));
  summary.add("photons", a.photons, line);
  std::snprintf(
      line, sizeof line,
      "reflected at diffuse hits %.4g W: deposited %.2f %%, outside the region %.2f %%, in a gap "
      "%.2f %%, hidden %.2f %%",
      a.reflected, percent(a.deposited, a.reflected), percent(a.outside, a.reflected),
      percent(a.gap, a.reflected), percent(a.hidden, a.reflected));
  summary.add("hits", a.hits, line);
  const auto dark = static_cast<uint64_t>(std::count(vpls.photons.begin(), vpls.photons.end(), 0u));
  std::snprintf(line, sizeof line,
                "median relative error of a VPL %.2g, %llu VPLs without a photon",
                double{medianError(vpls)}, static_cast<unsigned long long>(dark));
  summary.add("median_relative_error", medianError(vpls), line);
  summary.add("vpls_without_photon", dark);
  summary.add("rays", a.rays);
  summary.add("guard_rays", a.guardRays);
  summary.addNonFinite(a.nonFinite, "photons");
  summary.add("energy_W", {{"emitted", a.emitted},
                           {"escaped", a.escaped},
                           {"absorbed", a.absorbed},
                           {"reflected", a.reflected},
                           {"deposited", a.deposited},
                           {"dropped_outside", a.outside},
                           {"dropped_gap", a.gap},
                           {"dropped_hidden", a.hidden}});
}

int runEstimate(const SceneOptions& sceneOptions, const fs::path& input, const fs::path& output,
                const EstimateOptions& options, const CheckpointOptions& checkpoints,
                const ToolOptions& tool) {
  Summary summary("vpl-estimate");
  if (options.photons > kMaxPhotons) {
    throw UsageError("--photons is above 2^36, the most that can be summed up exactly");
  }
  requireWritable({output, tool.stats, tool.depfile});
  requireMemoryFor(input, kBytesPerVpl, "keep fewer with vpl-eliminate -n");
  VplTable vpls = readVpl(input, VplStage::Eliminated);
  const Scene scene = loadSceneFor("vpl-estimate", sceneOptions, /*needsLight=*/true);
  requireSameScene(input, vpls.sceneHash, scene, "rerun vpl-place and vpl-eliminate on this scene");
  const RayScene rays(scene);
  const LightSet lights(rays);

  const Json record =
      stageRecord("vpl-estimate", describe(options),
                  {{"scene", hashText(scene.contentHash)}, {"vpls", hashText(vpls.checksum)}});
  Checkpoint checkpoint(checkpoints, record);
  ProgressMeter meter("photons", options.photons, tool.quiet);
  const EnergyAccount account =
      estimateFlux(vpls, rays, lights, options, meter.callback(), checkpoint.resume());

  vpls.provenance = extendProvenance(vpls.provenance, record);
  OutputSet files;
  writeVpl(files.add(output), vpls);
  std::vector<fs::path> read = scene.files;
  read.push_back(input);
  addDepfile(files, tool.depfile, output, read);
  report(account, vpls, summary);
  summary.finish(tool, files);
  checkpoint.remove();
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Trace photons from the lights and hand their energy to the VPLs.", "vpl-estimate"};
  EstimateOptions options;
  ToolOptions tool;
  SceneOptions scene;
  fs::path input, output;
  addSceneOptions(cli, scene);
  cli.add_option("vpls", input, "from vpl-eliminate (.vpl)")->required();
  cli.add_option("-o,--output", output, "lit VPLs (.vpl)")->required();
  addCount(cli, "--photons", options.photons, "photons from all lights together");
  cli.add_option("--radius", options.radius,
                 "how far a VPL reaches for photons, in units of its r_max")
      ->check(inRange(0.01f, 100.0f))
      ->capture_default_str();
  addChoice(
      cli, "--scatter", options.scatter, kScatters,
      "guarded: to VPLs on a compatible surface and in sight; even: to all within reach (leaks)");
  addChoice(cli, "--recentre", options.recentre, kOnOff,
            "let each VPL shine from the centre of the energy that it received");
  cli.add_option("--max-bounces", options.maxBounces, "diffuse hits of a photon")
      ->check(inRange(1, 1000))
      ->capture_default_str();
  cli.add_option("--seed", options.seed, "random seed")->capture_default_str();
  CheckpointOptions checkpoints;
  addCheckpointOptions(cli, checkpoints);
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv,
                 [&] { return runEstimate(scene, input, output, options, checkpoints, tool); });
}
