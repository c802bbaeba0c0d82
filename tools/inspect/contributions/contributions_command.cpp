#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/memory.h"
#include "tools/common/files/depfile.h"
#include "tools/common/options/film_size.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/inspect/command.h"
#include "tools/inspect/contributions/contributions_json.h"
#include "tools/inspect/rows_on_scene.h"

namespace bnvpl {
namespace {

struct ContributionRequest {
  fs::path file, output;
  SceneOptions scene;
  std::string size;  // WxH; empty: contributionFilm()
  uint64_t perPixel = 64;
  double clamp = 2.0;
};

constexpr auto kPerPixelOption =
    countOption("per-pixel", "64", 4096, "", "VPLs that are listed for a pixel");

CLI::App* addContributionOptions(CLI::App& cli, ContributionRequest& c) {
  CLI::App* sub = cli.add_subcommand(
      "contributions",
      "List for each pixel of a small film the VPLs that light it most, with their shares.");
  addFile(*sub, "file", c.file, "lit .vpl")->required();
  addSceneFlag(*sub, c.scene, "the scene that the rows lie on")->required();
  addFile(*sub, "-o,--output", c.output, "the list (.json)")->required();
  sub->add_option("--size", c.size, "size of the film in pixels; default: 80 wide, in its shape")
      ->type_name("WIDTHxHEIGHT");
  addOption(*sub, kPerPixelOption,
            [&c](const Value& value) { c.perPixel = std::get<uint64_t>(value); });
  addReal(*sub,
          realOption("clamp", "2", 0, 1000, "radii of the VPL",
                     "radius of a VPL: 1/d^2 of a point is clamped within it, as by vpl-render"),
          c.clamp);
  addExamples(*sub,
              {{"which VPLs light which pixel",
                "vpl-inspect contributions lit.vpl --scene scene.toml -o contributions.json"}});
  return sub;
}

int runContributions(const ContributionRequest& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  RunFiles used;
  used.writes("-o", command.output, {OutputKind::Contributions}).writes(tool);
  RowsOnScene input = readRowsOnScene(command.file, command.scene, VplStage::Lit, used);
  const VplTable& table = input.rows;
  Scene& scene = input.scene;
  scene.film = command.size.empty() ? contributionFilm(scene.film) : parseSize(command.size);

  ContributionOptions options{.film = scene.film, .perPixel = command.perPixel};
  options.clamp = static_cast<float>(command.clamp);
  requireMemory(memoryOfContributions(options, table.size()),
                "contributions to " + sizeText(scene.film) + " pixels", "choose a smaller --size");
  const Accelerator accel(scene);
  const Contributions found = [&] {
    ProgressMeter meter("rows of pixels", scene.film.height, progressStyle(tool));
    return contributionsOf(accel, table, options, meter.callback());
  }();
  const Json list = contributionsJson(found, table, rowsInView(table, accel), options.clamp);

  OutputSet files;
  files.add(command.output).write(jsonText(list) + "\n");
  addDepfile(files, tool.depfile, command.output, input.files);
  const size_t lighting = static_cast<size_t>(
      std::ranges::count_if(found.radiance, [](double light) { return light > 0.0; }));
  char line[128];
  std::snprintf(line, sizeof line, "%zu of %zu rows light the %u x %u pixels", lighting,
                table.size(), scene.film.width, scene.film.height);
  summary.add("rows", table.size(), line);
  summary.add("rows_that_light", lighting);
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace

Command contributionsCommand(CLI::App& cli, ToolOptions& tool) {
  const auto request = std::make_shared<ContributionRequest>();
  CLI::App* sub = addContributionOptions(cli, *request);
  addDepfileOption(*sub, tool);
  return {sub,
          [request](const ToolOptions& options) { return runContributions(*request, options); }};
}

}  // namespace bnvpl
