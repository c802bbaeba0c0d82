// vpl-eliminate: keep the COUNT candidates that are spread best.
//   vpl-eliminate candidates.vpl -o vpls.vpl -n 3k
#include "formats/vpl_io.h"
#include "tools/common/choice.h"
#include "tools/common/memory.h"
#include "tools/common/run_files.h"
#include "tools/common/run_tool.h"
#include "tools/eliminate/eliminate.h"

namespace bnvpl {
namespace {

constexpr double kBytesPerCandidate = 120;  // measured: 140 to 150

const Choices<EliminationMethod> kMethods{{"elimination", EliminationMethod::Elimination},
                                          {"random", EliminationMethod::Random}};
const Choices<Density> kDensities{{"uniform", Density::Uniform}, {"local", Density::Local}};
const Choices<WeightLimiting> kLimitings{
    {"auto", WeightLimiting::Auto}, {"on", WeightLimiting::On}, {"off", WeightLimiting::Off}};

void addOptions(CLI::App& cli, EliminateOptions& options) {
  addCount(cli, "-n,--count", options.count, "VPLs to keep, exactly")->required();
  addChoice(cli, "--method", options.method, kMethods,
            "elimination: blue noise; random: any, for comparison");
  addChoice(cli, "--density", options.density, kDensities,
            "uniform: one radius; local: the radius follows the candidates' density");
  cli.add_option("--uniform-share", options.uniformShare,
                 "local: share of the VPLs that is spent evenly, the rest follows the candidates")
      ->check(inRange(0.0, 1.0))
      ->capture_default_str();
  cli.add_option("--area", options.area,
                 "indirectly visible area, scene units squared; 0: estimated from the candidates")
      ->check(inRange(0.0, 1e300))
      ->capture_default_str();
  cli.add_option("--alpha", options.alpha, "exponent of the pair weights")
      ->check(inRange(0.1, 64.0))
      ->capture_default_str();
  addChoice(cli, "--weight-limiting", options.weightLimiting, kLimitings,
            "treat all near pairs alike; auto: only with --area and uniform density");
  cli.add_option("--neighbours", options.neighbours, "k of the density estimate")
      ->check(inRange(1, 1000))
      ->capture_default_str();
  cli.add_option("--seed", options.seed, "random seed of --method random")->capture_default_str();
}

VplTable keepRows(const VplTable& candidates, const EliminateResult& kept) {
  VplTable vpls;
  vpls.stage = VplStage::Eliminated;
  for (const uint32_t row : kept.rows) {
    vpls.position.push_back(candidates.position[row]);
    vpls.normal.push_back(candidates.normal[row]);
    vpls.albedo.push_back(candidates.albedo[row]);
    vpls.id.push_back(candidates.id[row]);
  }
  vpls.radius = kept.radius;
  vpls.rMax = kept.rMax;
  vpls.areaEstimate = kept.area;
  vpls.sceneHash = candidates.sceneHash;
  return vpls;
}

Json describe(const EliminateOptions& options) {
  return {{"count", options.count},
          {"method", nameOf(options.method, kMethods)},
          {"density", nameOf(options.density, kDensities)},
          {"uniform-share", options.uniformShare},
          {"area", options.area},
          {"alpha", options.alpha},
          {"weight-limiting", nameOf(options.weightLimiting, kLimitings)},
          {"neighbours", options.neighbours},
          {"seed", options.seed}};
}

int runEliminate(const fs::path& input, const fs::path& output, const EliminateOptions& options,
                 const ToolOptions& tool) {
  Summary summary("vpl-eliminate");
  RunFiles().reads("candidates", input).writes("-o", output, {".vpl"}).writes(tool).ready();
  requireMemoryFor(input, kBytesPerCandidate, "place fewer with vpl-place -n");
  const VplTable candidates = readVpl(input, VplStage::Candidates);

  const EliminateResult kept = eliminate(candidates.position, candidates.normal, options);

  VplTable vpls = keepRows(candidates, kept);
  vpls.provenance = extendProvenance(candidates.provenance,
                                     stageRecord("vpl-eliminate", describe(options),
                                                 {{"candidates", hashText(candidates.checksum)}}));
  OutputSet files;
  writeVpl(files.add(output), vpls);
  addDepfile(files, tool.depfile, output, {input});

  summary.add("candidates", candidates.size());
  summary.add("kept", vpls.size(),
              "kept " + std::to_string(vpls.size()) + " of " + std::to_string(candidates.size()) +
                  " candidates");
  summary.add("area", kept.area);
  summary.add("r_max", kept.rMax,
              "area " + formatSi(kept.area) + ", r_max " + formatSi(kept.rMax) + " (scene units)");
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Keep the candidates that are spread best over the surfaces.", "vpl-eliminate"};
  EliminateOptions options;
  ToolOptions tool;
  fs::path input, output;
  cli.add_option("candidates", input, "from vpl-place (.vpl)")->required();
  cli.add_option("-o,--output", output, "VPLs without flux (.vpl)")->required();
  addOptions(cli, options);
  addToolOptions(cli, tool);
  addDepfileOption(cli, tool);
  return runTool(cli, tool, argc, argv, [&] { return runEliminate(input, output, options, tool); });
}
