#include <CLI/CLI.hpp>
#include <memory>

#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/stage/run_files.h"
#include "tools/common/stage/scene_options.h"
#include "tools/inspect/command.h"
#include "tools/inspect/doctor/doctor.h"

namespace bnvpl {
namespace {

struct DoctorRequest {
  SceneOptions scene;
  bool json = false;
};

int runDoctor(const DoctorRequest& command, const ToolOptions& tool) {
  const Summary summary("vpl-inspect");
  RunFiles used;
  used.reads("scene", command.scene.file).writes(tool).check();
  // The diagnosis contains the warnings.
  const Scene scene = loadSceneFor(command.scene, Warnings::Hold);
  used.ready(scene.files);
  if (tool.strict) printHeldWarnings();  // throws if there are any
  const Accelerator accel(scene);
  const Json diagnosis = diagnose(accel, LightSet(accel));
  saveStats("doctor", diagnosis, summary, tool);
  print(command.json ? jsonText(diagnosis, 2) + "\n" : doctorText(diagnosis));
  return kExitOk;
}

}  // namespace

Command doctorCommand(CLI::App& cli) {
  const auto request = std::make_shared<DoctorRequest>();
  CLI::App* sub = cli.add_subcommand(
      "doctor",
      "Tell what makes images of a scene dark, slow or wrong, and what to change: lights that face "
      "walls, a camera inside a solid, units, what is missing, and the cost.");
  addSceneOptions(*sub, request->scene);
  sub->add_flag("--json", request->json, "print the diagnosis as JSON");
  addExamples(*sub,
              {{"why a picture is dark", "vpl-inspect doctor scene.glb"},
               {"the same for another view", "vpl-inspect doctor scene.toml --view near.toml"}});
  return {sub, [request](const ToolOptions& options) { return runDoctor(*request, options); }};
}

}  // namespace bnvpl
