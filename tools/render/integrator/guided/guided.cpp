// Path tracing guided by the lit VPLs.
#include <array>
#include <memory>

#include "tools/common/streams.h"
#include "tools/render/integrator/guided/guided_tracer.h"
#include "tools/render/integrator/path_tracer.h"

namespace bnvpl::methods::integrator::guided {

namespace {

constexpr std::array kOptions{
    kMaxBouncesOption,
    realOption("guide-share", "0.5", 0, 0.99, "share of the directions",
               "chosen by the guide, the others by the BSDF"),
    wholeOption("guide-rays", "256", 0, 1024, "",
                "rays from each VPL that learn from where light comes; fewer in a short render"),
    specksOption("keep")};

// Rays that learn are to cost little beside the samples, of which each has several.
constexpr uint64_t kSamplesPerRay = 2;

uint64_t raysEach(const IntegratorInputs& in, const Values& options) {
  const Film& film = in.rays.scene().film;
  const uint64_t samples = uint64_t{film.width} * film.height * options.whole("spp");
  return std::min<uint64_t>(options.whole("guide-rays"),
                            samples / (kSamplesPerRay * std::max<size_t>(1, in.lit.size())));
}

Integrator make(const IntegratorInputs& in, const Values& options) {
  const auto tracer = std::make_shared<const GuidedTracer>(
      in.rays, in.lights,
      Guide(in.lit, in.rays, in.lights, in.seed, raysEach(in, options), in.progress),
      SurfaceLights(in.rays, in.lights, in.lit.position, in.lit.normal, in.lit.radius,
                    streamKey(in.seed, Stream::SurfaceLights), in.progress),
      options.real32("guide-share"), maxBouncesOf(options), in.only);
  return {[tracer](const TileSamples& tile) { tracer->render(tile); }};
}

}  // namespace

extern const IntegratorMethod method;
const IntegratorMethod method{"guided",
                              "path tracing towards where the VPLs say that light comes from",
                              kOptions, make, /*needsVpls=*/true};

}  // namespace bnvpl::methods::integrator::guided
