#include "tools/inspect/commands.h"

#include <cstdio>

#include "formats/png_io.h"
#include "formats/vpl_io.h"
#include "tools/common/film_size.h"
#include "tools/common/standard_streams.h"
#include "tools/inspect/chain.h"
#include "tools/inspect/check.h"
#include "tools/inspect/export_table.h"
#include "tools/inspect/info.h"

namespace bnvpl {

int runInfo(const InfoCommand& command) {
  const Json description = describeFile(command.file);
  const std::string text = command.json ? description.dump(2) + "\n" : infoText(description);
  print(text);
  return kExitOk;
}

int runCheck(const CheckCommand& command, const ToolOptions& tool) {
  std::vector<CheckedFile> checked;
  for (const fs::path& file : command.files) {
    checked.push_back(checkFile(file));
    if (!tool.quiet) print(file.string() + ": OK (" + checked.back().what + ")\n");
  }
  if (command.deep) {
    std::string sceneHash;
    if (!command.scene.file.empty())
      sceneHash = hashText(loadSceneFor("vpl-inspect", command.scene).contentHash);
    checkChain(checked, command.scene.file.empty() ? "SCENE" : command.scene.file.string(),
               sceneHash);
    if (!tool.quiet) print("one whole chain\n");
    return kExitOk;
  }
  checkTogether(checked);
  if (!tool.quiet && checked.size() > 1) print("no contradiction between the files\n");
  return kExitOk;
}

int runExport(const ExportCommand& command, const ToolOptions& tool) {
  requireExportable(command.output);
  Summary summary("vpl-inspect");
  requireWritable({command.output, tool.stats});
  const VplTable table = readVpl(command.file);
  OutputSet files;
  exportTable(table, files.add(command.output));
  summary.add("rows", table.size(), "wrote " + std::to_string(table.size()) + " rows");
  summary.finish(tool, files);
  return kExitOk;
}

int runPlot(const PlotCommand& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  requireWritable({command.output, tool.stats, tool.depfile});
  const VplTable table = readVpl(command.file);
  Scene scene = loadSceneFor("vpl-inspect", command.scene);
  requireSameScene(command.file, table.sceneHash, scene,
                   "name the scene it was made from, or rerun vpl-place");
  if (!command.size.empty()) scene.film = parseSize(command.size);
  PlotOptions options = command.plot;
  if (!command.colourGiven && table.stage == VplStage::Lit) options.colour = DotColour::Flux;

  const RayScene rays(scene);
  PlotCounts counts;
  std::vector<Dot> dots = visibleDots(table, rays, options, counts);
  Canvas canvas = shadeView(rays, options.samples);
  canvas.paint(std::move(dots), options.dotPixels);
  OutputSet files;
  writePng(files.add(command.output), canvas.width, canvas.height, canvas.rgb8());
  std::vector<fs::path> read = scene.files;
  read.push_back(command.file);
  addDepfile(files, tool.depfile, command.output, read);

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

}  // namespace bnvpl
