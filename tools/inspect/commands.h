// The subcommands of vpl-inspect. Each reads files, calls the library, writes the result and
// returns the exit code.
#pragma once

#include "images/error_map.h"
#include "tools/common/scene_options.h"
#include "tools/inspect/compare_report.h"
#include "tools/inspect/plot.h"

namespace bnvpl {

struct InfoCommand {
  fs::path file;
  bool json = false;
};
struct CheckCommand {
  std::vector<fs::path> files;
  bool deep = false;
  SceneOptions scene;  // without file: the scene is not checked
};
struct ExportCommand {
  fs::path file, output;
};
struct PlotCommand {
  fs::path file, output;
  SceneOptions scene;
  PlotOptions plot;
  bool colourGiven = false;  // false: flux for lit rows, plain for others
  std::string size;          // WxH, empty: the scene's film
};
struct SceneCommand {
  SceneOptions scene;
  bool json = false;
  fs::path toml;  // folder to write the scene to in bnvpl's format; empty: none
};
struct RunCommand {
  fs::path folder, svg;
  bool json = false;
};
struct CompareCommand {
  fs::path imageA, imageB, secondB, mask, diff;
  std::string layer, layerA, layerB;  // layerA and layerB override `layer`
  CompareOptions limits;
  std::string exposure;       // for LDR-FLIP, stops or auto
  std::string flipExposures;  // for HDR-FLIP, START:STOP or auto; empty: as in `flip`
  FlipOptions flip;
  std::vector<const CLI::Option*> ofFlip;  // options that only FLIP uses
  MapKind map = MapKind::Difference;
  std::optional<double> diffRange;  // value at the end of the colour scale; none: the map's own
  bool json = false;
};

int runInfo(const InfoCommand& command, const ToolOptions& tool);
int runCheck(const CheckCommand& command, const ToolOptions& tool);
int runExport(const ExportCommand& command, const ToolOptions& tool);
int runPlot(const PlotCommand& command, const ToolOptions& tool);
int runScene(const SceneCommand& command, const ToolOptions& tool);
int runRun(const RunCommand& command, const ToolOptions& tool);
int runCompare(const CompareCommand& command, const ToolOptions& tool);

// Adds the subcommand `compare` with its options.
CLI::App* addCompare(CLI::App& cli, CompareCommand& command);

}  // namespace bnvpl
