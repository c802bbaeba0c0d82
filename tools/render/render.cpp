#include "tools/render/render.h"

#include <array>

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"

namespace bnvpl {

namespace {

const std::string& layersHelp() {
  static const std::string help = "extra channels of the image, or all" + layerList();
  return help;
}

std::span<const Option> stageOptions() {
  static const std::array options{
      countOption("spp", "8", 0x1p32 - 1, "", "samples a pixel"),
      choiceOption("only", "all", "all|direct|indirect", "which light the image shows"),
      seedOption(),
      unrecorded(textOption("layers", "", "NAME,...", layersHelp())),
      unrecorded(textOption("size", "", "WIDTHxHEIGHT",
                            "another film than the scene's, with the same vertical field of view")),
      choiceOption("pixels", "float", "half|float", "EXR channel type"),
      unrecorded(
          textOption("exposure", "auto", "EV|auto", "of the PNG, in stops; auto: middle grey"))};
  return options;
}

Only onlyOf(const Values& options) {
  const std::string& name = options.text("only");
  return name == "direct" ? Only::Direct : name == "indirect" ? Only::Indirect : Only::Everything;
}

// The integrators in whose images VPLs shine.
std::string gathering() {
  std::string names;
  for (const IntegratorMethod* m : integratorMethods()) {
    if (m->gathers) names += (names.empty() ? "" : "|") + std::string(m->name);
  }
  return "integrator=" + names;
}

}  // namespace

const StageSpec& renderSpec() {
  static const std::string vpls = gathering(), shown = vpls + ",only=all|indirect";
  static const StageSpec spec{
      "vpl-render",
      stageOptions(),
      {{"integrator", "vpl", "what finds the light", entriesOf(integratorMethods())},
       {"gather", "tilecuts", "how VPLs are gathered", entriesOf(gatherMethods()), shown},
       {"compensate", "near-field", "what makes good the light that VPLs do not bring",
        entriesOf(compensateMethods()), vpls}}};
  return spec;
}

const IntegratorMethod& integratorOf(const Values& options) {
  return methodNamed(integratorMethods(), options.text("integrator"));
}

std::vector<const Layer*> layersOf(const Values& options) {
  return parseLayers(options.text("layers"),
                     integratorOf(options).gathers && onlyOf(options) != Only::Direct);
}

uint64_t renderWork(const Scene& scene, const Values& options) {
  const uint64_t samples = uint64_t{scene.film.width} * scene.film.height * options.whole("spp");
  const bool photons = integratorOf(options).photons && onlyOf(options) != Only::Direct;
  return photons ? 2 * samples : samples;
}

RenderResult render(const RayScene& rays, const LightSet& lights, const VplTable& lit,
                    const Values& options, const ProgressFn& progress, const Resume& resume) {
  const FilmOptions film{static_cast<uint32_t>(options.whole("spp")), options.whole("seed"),
                         onlyOf(options), layersOf(options)};
  const Integrator integrator =
      integratorOf(options).make({rays, lights, lit, film.seed, film.only, progress}, options);
  RenderResult result;
  result.image = renderFilm(rays.scene(), integrator, film, result.stats, progress, resume);
  result.vpls = integrator.vpls;
  return result;
}

}  // namespace bnvpl
