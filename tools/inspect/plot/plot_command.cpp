#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/memory.h"
#include "formats/image/png_io.h"
#include "tools/common/files/depfile.h"
#include "tools/common/options/choice.h"
#include "tools/common/options/film_size.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/inspect/command.h"
#include "tools/inspect/contributions/contributions.h"
#include "tools/inspect/plot/plot.h"
#include "tools/inspect/rows_on_scene.h"

namespace bnvpl {

namespace {

const Choices<DotColour> kDotColours{{"flux", DotColour::Flux},
                                     {"contribution", DotColour::Contribution},
                                     {"radius", DotColour::Radius},
                                     {"plain", DotColour::Plain}};

struct PlotRequest {
  fs::path file, output;
  SceneOptions scene;
  PlotOptions plot;
  bool colourGiven = false;  // false: flux for lit rows, plain for others
  std::string size;          // WxH, empty: the scene's film
};

CLI::App* addPlotOptions(CLI::App& cli, PlotRequest& c) {
  CLI::App* sub =
      cli.add_subcommand("plot", "Draw the rows as dots over the camera's view of the scene.");
  addFile(*sub, "file", c.file, ".vpl")->required();
  addSceneFlag(*sub, c.scene, "the scene that the rows lie on")->required();
  addFile(*sub, "-o,--output", c.output, "picture (.png)")->required();
  addReal(*sub, realOption("dot", "", 1, 100, "pixels", "diameter of a dot"), c.plot.dotPixels);
  addChoice(
      *sub, "--color", c.plot.colour, kDotColours,
      "quantity that colours the dots, from violet (low) to yellow (high); contribution is the "
      "light of a VPL in the view")
      ->default_str("flux if lit, else plain");
  sub->add_flag("--show-back", c.plot.showBack,
                "draw rings for visible rows whose lit side faces away");
  sub->add_option("--size", c.size, "size of the picture in pixels; default: the scene's film")
      ->type_name("WIDTHxHEIGHT");
  addExamples(*sub,
              {{"the VPLs in the view", "vpl-inspect plot lit.vpl --scene scene.toml -o vpls.png"},
               {"their radii, as large dots",
                "vpl-inspect plot lit.vpl --scene scene.toml -o radii.png --color radius --dot 9"},
               {"which of them light the view",
                "vpl-inspect plot lit.vpl --scene scene.toml -o dots.png --color contribution"}});
  return sub;
}

int runPlot(const PlotRequest& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  RunFiles used;
  used.writes("-o", command.output, {OutputKind::Png}).writes(tool);
  const bool byContribution = command.plot.colour == DotColour::Contribution;
  RowsOnScene input =
      readRowsOnScene(command.file, command.scene,
                      byContribution ? std::optional(VplStage::Lit) : std::nullopt, used);
  const VplTable& table = input.rows;
  Scene& scene = input.scene;
  if (!command.size.empty()) scene.film = parseSize(command.size);
  PlotOptions options = command.plot;
  if (!command.colourGiven && table.stage == VplStage::Lit) options.colour = DotColour::Flux;

  requireColours(command.file, table, options.colour);
  // Radiance and 8 bits of each channel.
  requireMemory(15.0 * double(scene.film.width) * double(scene.film.height), "the picture",
                "choose a smaller --size");
  const Accelerator accel(scene);
  if (byContribution) {
    ProgressMeter meter("rows of pixels", contributionFilm(scene.film).height, progressStyle(tool));
    options.contributions =
        contributionsOf(accel, table, {.film = contributionFilm(scene.film)}, meter.callback())
            .radiance;
  }
  PlotCounts counts;
  std::vector<Dot> dots = visibleDots(table, accel, options, counts);
  Canvas canvas = shadeView(accel, options.samples);
  canvas.paint(std::move(dots), static_cast<float>(options.dotPixels));
  OutputSet files;
  writePng(files.add(command.output), canvas.width, canvas.height, canvas.rgb8());
  addDepfile(files, tool.depfile, command.output, input.files);

  char line[160];
  std::snprintf(line, sizeof line,
                "%zu rows: %zu in sight, %zu facing away, %zu hidden, %zu outside the film",
                table.size(), counts.drawn, counts.facingAway, counts.occluded, counts.outside);
  summary.add("rows", table.size(), line);
  summary.add("in_sight", counts.drawn);
  summary.add("facing_away", counts.facingAway);
  summary.add("hidden", counts.occluded);
  summary.add("outside_film", counts.outside);
  summary.finish(tool, files);
  return kExitOk;
}

}  // namespace

Command plotCommand(CLI::App& cli, ToolOptions& tool) {
  const auto request = std::make_shared<PlotRequest>();
  CLI::App* sub = addPlotOptions(cli, *request);
  addDepfileOption(*sub, tool);
  return {sub, [request, sub](const ToolOptions& options) {
            request->colourGiven = sub->count("--color") > 0;
            return runPlot(*request, options);
          }};
}

}  // namespace bnvpl
