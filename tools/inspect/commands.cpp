#include "tools/inspect/commands.h"

#include <cstdio>
#include <optional>

#include "formats/png_io.h"
#include "formats/vpl_io.h"
#include "tools/common/depfile.h"
#include "tools/common/escape_text.h"
#include "tools/common/exit_codes.h"
#include "tools/common/film_size.h"
#include "tools/common/run_files.h"
#include "tools/common/standard_streams.h"
#include "tools/inspect/chain.h"
#include "tools/inspect/check.h"
#include "tools/inspect/export_table.h"
#include "tools/inspect/info.h"
#include "tools/inspect/run_report.h"
#include "tools/inspect/run_timeline.h"
#include "tools/inspect/scene_report.h"
#include "tools/inspect/write_scene.h"

namespace bnvpl {

namespace {

// Writes the figures of a command whose report goes to stdout to --stats, under the command's name.
void saveStats(const char* command, Json figures, const Summary& start, const ToolOptions& tool) {
  Summary summary = start;
  summary.add(command, std::move(figures));
  OutputSet files;
  summary.save(tool, files);
}

Json describeChecked(const std::vector<CheckedFile>& files, const std::string& scene, bool deep) {
  Json json{{"files", Json::array()}, {"deep", deep}};
  for (const CheckedFile& f : files) {
    Json entry{{"file", f.file.string()}, {"what", f.what}};
    if (!f.checksum.empty()) entry["checksum"] = f.checksum;
    if (!f.scene.empty()) entry["scene"] = f.scene;
    json["files"].push_back(std::move(entry));
  }
  if (!scene.empty()) json["scene"] = scene;
  return json;
}

// Throws UsageError if a folder that will be replaced as a whole holds other files of the run.
void requireOutside(const fs::path& folder, const std::vector<fs::path>& files,
                    const std::string& what) {
  std::error_code ignored;
  const fs::path place = fs::weakly_canonical(folder / "", ignored);
  for (const fs::path& file : files) {
    const fs::path inside = fs::weakly_canonical(file, ignored).lexically_relative(place);
    if (file.empty() || inside.empty() || *inside.begin() == "..") continue;
    throw UsageError("--to-toml '" + folder.string() + "' holds '" + file.string() + "', which " +
                     what + "; name a folder that does not exist yet");
  }
}

}  // namespace

int runInfo(const InfoCommand& command, const ToolOptions& tool) {
  const Summary summary("vpl-inspect");
  RunFiles().reads("file", command.file).writes(tool).ready();
  const Json description = describeFile(command.file);
  const std::string text = command.json ? jsonText(description, 2) + "\n" : infoText(description);
  saveStats("info", description, summary, tool);
  print(text);
  return kExitOk;
}

int runCheck(const CheckCommand& command, const ToolOptions& tool) {
  const Summary summary("vpl-inspect");
  const bool withScene = !command.scene.file.empty();
  RunFiles used;
  for (const fs::path& file : command.files) used.reads("file", file);
  used.reads("--scene", command.scene.file).writes(tool).check();
  Scene scene;
  if (withScene) scene = loadSceneFor(command.scene, Warnings::Hold);
  used.ready(scene.files);

  const auto say = [&](const std::string& line) {
    if (!tool.quiet) print(escapedLine(line) + "\n");
  };
  std::vector<CheckedFile> checked;
  for (const fs::path& file : command.files) {
    checked.push_back(checkFile(file));
    if (withScene && checked.back().stage) requireRadiiWithin(file, readVpl(file).radius, scene);
    say(file.string() + ": OK (" + checked.back().what + ")");
  }
  const std::string hash = withScene ? hashText(scene.contentHash) : "";
  if (command.deep) {
    checkChain(checked, withScene ? &scene : nullptr);
  } else {
    checkTogether(checked);
    if (withScene) checkScene(checked, scene);
  }
  saveStats("check", describeChecked(checked, hash, command.deep), summary, tool);
  if (command.deep)
    say("one whole chain");
  else if (checked.size() > 1)
    say("no contradiction between the files");
  if (withScene) say("made from " + scene.name() + " as it is now");
  const std::string placedFor = withScene ? placedForAnotherView(checked, scene) : "";
  if (!placedFor.empty()) {
    say("the VPLs were placed for another view, which is no error: they light any (theirs: " +
        placedFor + ")");
  }
  return kExitOk;
}

int runExport(const ExportCommand& command, const ToolOptions& tool) {
  requireExportable(command.output);
  Summary summary("vpl-inspect");
  RunFiles()
      .reads("file", command.file)
      .writes("-o", command.output, {OutputKind::Ply, OutputKind::Csv})
      .writes(tool)
      .ready();
  const VplTable table = readVpl(command.file);
  OutputSet files;
  exportTable(table, files.add(command.output));
  summary.add("rows", table.size(), "wrote " + std::to_string(table.size()) + " rows");
  summary.finish(tool, files);
  return kExitOk;
}

int runScene(const SceneCommand& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  RunFiles used;
  used.reads("scene", command.scene.file).writes(tool).check();
  std::optional<OutputFolder> folder;
  if (!command.toml.empty()) {
    requireOutside(command.toml, {command.scene.file}, "the run reads");
    requireOutside(command.toml, {tool.stats, tool.depfile}, "is another output");
    folder.emplace(command.toml);
  }
  // The report contains the warnings.
  const Scene scene = loadSceneFor(command.scene, Warnings::Hold);
  used.ready(scene.files);
  if (folder) requireOutside(command.toml, scene.files, "the run reads");
  const RayScene rays(scene);
  Json description = describeScene(scene, LightSet(rays));
  if (folder) {
    writeSceneToml(scene, *folder);
    folder->commit();
  }
  OutputSet files;
  const std::string text = command.json ? jsonText(description, 2) + "\n" : sceneText(description);
  summary.add("scene", std::move(description));
  summary.save(tool, files);
  print(text);
  return kExitOk;
}

int runRun(const RunCommand& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  RunFiles().writes("--svg", command.svg, {OutputKind::Svg}).writes(tool).ready();
  const RunRecords run = readRunRecords(command.folder);
  const Json description = describeRun(run);
  OutputSet files;
  if (!command.svg.empty()) files.add(command.svg).write(timelineSvg(run));
  const std::string text = command.json ? jsonText(description, 2) + "\n" : runText(description);
  summary.add("run", description);
  summary.save(tool, files);
  print(text);
  return kExitOk;
}

int runPlot(const PlotCommand& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  RunFiles used;
  used.reads("file", command.file).reads("--scene", command.scene.file);
  used.writes("-o", command.output, {OutputKind::Png}).writes(tool).check();
  const VplTable table = readVpl(command.file);
  Scene scene = loadSceneFor(command.scene, Warnings::Hold);
  used.ready(scene.files);
  requireSameScene(command.file, table.sceneHash, scene,
                   "name the scene it was made from, or rerun vpl-place");
  if (!command.size.empty()) scene.film = parseSize(command.size);
  PlotOptions options = command.plot;
  if (!command.colourGiven && table.stage == VplStage::Lit) options.colour = DotColour::Flux;

  const RayScene rays(scene);
  PlotCounts counts;
  std::vector<Dot> dots = visibleDots(table, rays, options, counts);
  Canvas canvas = shadeView(rays, options.samples);
  canvas.paint(std::move(dots), static_cast<float>(options.dotPixels));
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
