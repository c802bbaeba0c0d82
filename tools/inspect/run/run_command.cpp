#include <CLI/CLI.hpp>
#include <memory>

#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/inspect/command.h"
#include "tools/inspect/run/run_report.h"
#include "tools/inspect/run/run_timeline.h"

namespace bnvpl {

namespace {

struct RunRequest {
  fs::path folder, svg;
  bool json = false;
};

CLI::App* addRunOptions(CLI::App& cli, RunRequest& c) {
  CLI::App* sub = cli.add_subcommand(
      "run",
      "Report the tasks of a pipeline: stages, hosts, CPU time and the critical path, from the "
      "records of pipelines/slurm/submit.py or generate_ninja.py --record.");
  sub->add_option("folder", c.folder, "folder of the records: OUT/SCENE/run")
      ->required()
      ->type_name("FOLDER");
  addFile(*sub, "--svg", c.svg, "timeline (.svg): hosts downwards, time to the right");
  sub->add_flag("--json", c.json, "print the report as JSON, with every attempt");
  addExamples(*sub, {{"what a pipeline spent its time on",
                      "vpl-inspect run out/cornell/run --svg timeline.svg"}});
  return sub;
}

int runRun(const RunRequest& command, const ToolOptions& tool) {
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

}  // namespace

Command runCommand(CLI::App& cli) {
  const auto request = std::make_shared<RunRequest>();
  CLI::App* sub = addRunOptions(cli, *request);
  return {sub, [request](const ToolOptions& options) { return runRun(*request, options); }};
}

}  // namespace bnvpl
