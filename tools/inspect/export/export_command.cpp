#include <CLI/CLI.hpp>
#include <memory>

#include "formats/vpl/vpl_io.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/inspect/command.h"
#include "tools/inspect/export/export_table.h"

namespace bnvpl {

namespace {

struct ExportRequest {
  fs::path file, output;
};

CLI::App* addExportOptions(CLI::App& cli, ExportRequest& c) {
  CLI::App* sub = cli.add_subcommand("export", "Write the rows for other programs.");
  addFile(*sub, "file", c.file, ".vpl")->required();
  addFile(*sub, "-o,--output", c.output, ".ply (MeshLab, Blender) or .csv")->required();
  addExamples(*sub, {{"the VPLs for Blender or MeshLab", "vpl-inspect export lit.vpl -o lit.ply"},
                     {"the VPLs as a table", "vpl-inspect export lit.vpl -o lit.csv"}});
  return sub;
}

int runExport(const ExportRequest& command, const ToolOptions& tool) {
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

}  // namespace

Command exportCommand(CLI::App& cli) {
  const auto request = std::make_shared<ExportRequest>();
  CLI::App* sub = addExportOptions(cli, *request);
  return {sub, [request](const ToolOptions& options) { return runExport(*request, options); }};
}

}  // namespace bnvpl
