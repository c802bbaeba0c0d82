// vpl-inspect: describes, checks, exports, plots and compares the files of the stages.
//   vpl-inspect info lit.vpl
//   vpl-inspect compare image.exr reference.exr --layer indirect --max-relmse 0.01 --diff diff.png
#include <CLI/CLI.hpp>

#include "tools/common/choice.h"
#include "tools/inspect/commands.h"

namespace bnvpl {
namespace {

const Choices<DotColour> kDotColours{
    {"flux", DotColour::Flux}, {"radius", DotColour::Radius}, {"plain", DotColour::Plain}};

CLI::App* addInfo(CLI::App& cli, InfoCommand& c) {
  CLI::App* sub = cli.add_subcommand("info",
                                     "Header, history, columns and spacing of a .vpl file, "
                                     "channels of an .exr image, or what a .shard holds.");
  addFile(*sub, "file", c.file, ".vpl, .exr or .shard")->required();
  sub->add_flag("--json", c.json, "print the report as JSON");
  return sub;
}

CLI::App* addCheck(CLI::App& cli, CheckCommand& c) {
  CLI::App* sub = cli.add_subcommand("check", "Verify files; several also against each other.");
  addFile(*sub, "files", c.files, ".vpl and .exr")->required();
  sub->add_flag("--deep", c.deep,
                "require one complete chain of files, checked row by row; an error ends with the "
                "commands that repair the chain");
  addSceneFlag(*sub, c.scene, "the scene (.toml) that all files must have been made from");
  return sub;
}

CLI::App* addExport(CLI::App& cli, ExportCommand& c) {
  CLI::App* sub = cli.add_subcommand("export", "Write the rows for other programs.");
  addFile(*sub, "file", c.file, ".vpl")->required();
  addFile(*sub, "-o,--output", c.output, ".ply (MeshLab, Blender) or .csv")->required();
  return sub;
}

CLI::App* addScene(CLI::App& cli, SceneCommand& c) {
  CLI::App* sub = cli.add_subcommand(
      "scene",
      "Report how a scene is interpreted: meshes, materials, lights with their power, cameras, "
      "textures, and everything that is ignored or approximated.");
  addSceneOptions(*sub, c.scene);
  sub->add_flag("--json", c.json, "print the report as JSON");
  sub->add_option(
         "--to-toml", c.toml,
         "also write the scene as scene.toml, OBJ and MTL; the folder must be new, empty or "
         "written by this option")
      ->type_name("FOLDER");
  return sub;
}

CLI::App* addPlot(CLI::App& cli, PlotCommand& c) {
  CLI::App* sub =
      cli.add_subcommand("plot", "Draw the rows as dots over the camera's view of the scene.");
  addFile(*sub, "file", c.file, ".vpl")->required();
  addSceneFlag(*sub, c.scene, "the scene (.toml) that the rows lie on")->required();
  addFile(*sub, "-o,--output", c.output, "picture (.png)")->required();
  addReal(*sub, realOption("dot", "", 1, 100, "pixels", "diameter of a dot"), c.plot.dotPixels);
  addChoice(*sub, "--color", c.plot.colour, kDotColours,
            "quantity that colours the dots, from violet (low) to yellow (high)")
      ->default_str("flux if lit, else plain");
  sub->add_flag("--show-back", c.plot.showBack,
                "draw rings for visible rows whose lit side faces away");
  sub->add_option("--size", c.size, "size of the picture in pixels; default: the scene's film")
      ->type_name("WIDTHxHEIGHT");
  return sub;
}

CLI::App* addRun(CLI::App& cli, RunCommand& c) {
  CLI::App* sub = cli.add_subcommand(
      "run",
      "Report the tasks of a pipeline: stages, hosts, CPU time and the critical path, from the "
      "records of pipelines/slurm/submit.py or generate_ninja.py --record.");
  sub->add_option("folder", c.folder, "folder of the records: OUT/SCENE/run")
      ->required()
      ->type_name("FOLDER");
  addFile(*sub, "--svg", c.svg, "timeline (.svg): hosts downwards, time to the right");
  sub->add_flag("--json", c.json, "print the report as JSON, with every attempt");
  return sub;
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): only a wrongly declared option throws, at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  CLI::App cli{"Describe, check, export, plot and compare the files of the stages.", "vpl-inspect"};
  ToolOptions tool;
  cli.fallthrough();  // --threads and --quiet may stand after the subcommand too
  addToolOptions(cli, tool);
  cli.require_subcommand(1);
  InfoCommand info;
  CheckCommand check;
  ExportCommand exported;
  PlotCommand plot;
  SceneCommand scene;
  RunCommand run;
  CompareCommand compare;
  const CLI::App* infoCli = addInfo(cli, info);
  const CLI::App* checkCli = addCheck(cli, check);
  const CLI::App* exportCli = addExport(cli, exported);
  const CLI::App* sceneCli = addScene(cli, scene);
  CLI::App* plotCli = addPlot(cli, plot);
  addDepfileOption(*plotCli, tool);
  const CLI::App* runCli = addRun(cli, run);
  addCompare(cli, compare);
  return runTool(cli, tool, argc, argv, [&] {
    plot.colourGiven = plotCli->count("--color") > 0;
    if (infoCli->parsed()) return runInfo(info, tool);
    if (checkCli->parsed()) return runCheck(check, tool);
    if (exportCli->parsed()) return runExport(exported, tool);
    if (sceneCli->parsed()) return runScene(scene, tool);
    if (plotCli->parsed()) return runPlot(plot, tool);
    if (runCli->parsed()) return runRun(run, tool);
    return runCompare(compare, tool);
  });
}
