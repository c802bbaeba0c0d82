// vpl-render: renders direct light plus all VPLs, or a reference by path or light tracing.
//   vpl-render scene.toml lit.vpl -o image.exr --spp 8 --png image.png
#include "core/hash.h"
#include "tools/common/stage/stage_run.h"
#include "tools/render/cost_of_rendering.h"
#include "tools/render/inputs.h"
#include "tools/render/preview_outputs.h"

namespace bnvpl {
namespace {

int runRender(StageRequest& request, const RenderFiles& files, const ToolOptions& tool) {
  StageRun run("vpl-render", request, tool);
  Values options = resolveRender(request.given);
  requireConsistent(options, request.given, files, request.shard.has_value());
  run.used.reads("scene", request.scene.file).reads("lit", files.lit);
  Previews previews(files.viewer);
  run.used.writes("-o", request.output, {request.shard ? OutputKind::Shard : OutputKind::Exr});
  run.used.writes("--png", files.png, {OutputKind::Png});
  run.checkFiles();
  const VplTable lit = readLit(files.lit, options, run.predictsCost());
  Scene scene = loadSceneFor(request.scene, files.lit.empty() ? Warnings::Print : Warnings::Hold);
  run.filesReady(scene.files);
  resolveFilm(request.given, options, scene);
  if (!files.lit.empty()) checkLit(scene, lit, files.lit);
  if (!run.predictsCost()) requireMemoryForImage(scene, options);
  const Film film = scene.film;
  if (run.predictsCost()) scene.film = filmToTry(film);
  const Accelerator accel(scene, tool.processor);
  const LightSet lights(accel);
  checkLights(scene, lights, options, files);
  if (run.predictsCost()) {
    return run.predictCost("samples,", [&](const ProgressFn& progress) {
      const ImageToMake image{film, request.given, options, request.shard.has_value()};
      return costOfRendering(accel, lights, lit, image, progress);
    });
  }

  Json inputs{{"scene", hashText(scene.contentHash)}};
  if (!files.lit.empty()) inputs["lit"] = hashText(lit.checksum);
  const auto record = [&](const Json& recorded) {
    Json json = stageRecord("vpl-render", recorded, inputs, tool.processor);
    json["view"] = viewRecord(scene);
    return json;
  };
  const auto result = [&](const StageTask& t, const FilmPreview& preview) {
    return render(accel, lights, lit, options, t.progress, t.controls, preview, run.startS());
  };
  const ImagePaths images{request.output, files.png};
  const auto whole = [&](const StageTask& task) {
    RenderResult all = result(task, previews.begin(images, options, film));
    const Values made = optionsMade(all, request.given);
    finishImage(all, made, extendProvenance(lit.provenance, record(recordOf(renderSpec(), made))));
    warnOfIdle(all, request.given);
    reportRender(all, made, task.summary);
    addImages(task.files, images, all.image, options, task.summary);
    previews.finish(all.image, task.summary);
  };
  const auto part = [&](const StageTask& task) -> ShardRun {
    const Json made = record(recordOf(renderSpec(), options));
    const RenderResult rendered = result(task, {});
    return {withLayers(made, options), request.given, sourcesOf(rendered), request.command,
            extendProvenance(lit.provenance, made)};
  };
  return run.execute({record(resumableOptions(options)), "samples", renderWork(scene, options),
                      filesRead(scene, files), whole, part});
}

}  // namespace
}  // namespace bnvpl

// NOLINTNEXTLINE(bugprone-exception-escape): options declared wrongly would throw at every start
int main(int argc, char** argv) {
  using namespace bnvpl;
  const CommandLine cli{"Render the scene, lit by its lights and the VPLs.", "vpl-render"};
  ToolOptions tool;
  StageRequest request;
  RenderFiles files;
  addSceneOptions(cli, request.scene);
  addFile(cli, "lit", files.lit, "lit VPLs (.vpl), for integrators that take them");
  required(addFile(cli, "-o,--output", request.output, "image (.exr)"));
  addFile(cli, "--png", files.png, "also write a preview");
  addPreviewOption(cli, files.viewer);
  addStageRequest(cli, renderSpec(), request, tool, "tiles and photons");
  return runTool(cli, tool, argc, argv, [&] {
    request.command = commandOf(cli);
    return runRender(request, files, tool);
  });
}
