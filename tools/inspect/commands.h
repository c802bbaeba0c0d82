// The subcommands of vpl-inspect: read, call, write. Each returns the exit code.
#pragma once

#include "tools/common/scene_options.h"
#include "tools/inspect/compare.h"
#include "tools/inspect/plot.h"

namespace bnvpl {

struct InfoCommand {
  fs::path file;
  bool json = false;
};
struct CheckCommand {
  std::vector<fs::path> files;
};
struct ExportCommand {
  fs::path file, output;
};
struct PlotCommand {
  fs::path file, output;
  SceneOptions scene;
  PlotOptions plot;
  bool colourGiven = false;  // else flux for lit rows, plain for others
  std::string size;          // WxH, empty: the scene's film
};
struct CompareCommand {
  fs::path imageA, imageB, secondB, diff;
  std::string layer, layerA, layerB;  // layerA and layerB go first
  CompareOptions limits;
  double diffRange = 0.5;  // relative difference at the ends of the colour scale
  bool json = false;
};

int runInfo(const InfoCommand& command);
int runCheck(const CheckCommand& command, const ToolOptions& tool);
int runExport(const ExportCommand& command, const ToolOptions& tool);
int runPlot(const PlotCommand& command, const ToolOptions& tool);
int runCompare(const CompareCommand& command);

}  // namespace bnvpl
