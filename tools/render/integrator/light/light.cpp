// Light tracing for the indirect light of directly visible surfaces, path tracing for the rest.
#include <array>
#include <memory>

#include "tools/render/integrator/light/light_tracer.h"
#include "tools/render/integrator/path_tracer.h"

namespace bnvpl::methods::integrator::light {

namespace {

constexpr auto kOptions = optionTable(kMaxBouncesOption);

Integrator make(const IntegratorInputs& in, const Values& options) {
  const unsigned maxBounces = maxBouncesOf(options);
  const bool photons = in.shown != ShownLight::Direct;
  const auto paths =
      std::make_shared<const PathTracer>(in.accel, in.lights, maxBounces, in.shown, !photons);
  Integrator result{[paths](const TileSamples& tile) { paths->render(tile); }};
  if (photons) {
    const auto tracer =
        std::make_shared<const LightTracer>(in.accel, in.lights, in.filter, maxBounces, in.seed);
    result.idle = {"adaptive"};  // photons cannot be aimed at tiles
    result.splatPhotons = [tracer](uint64_t begin, uint64_t end, Splats& out) {
      tracer->follow(begin, end, out);
    };
  }
  return result;
}

}  // namespace

extern const IntegratorMethod method{
    "light",
    "path tracing, with indirect light by light tracing, for scenes where paths hardly find the "
    "lights; takes no VPLs",
    kOptions,
    make,
    /*needsVpls=*/false,
    /*splatsPhotons=*/true};

}  // namespace bnvpl::methods::integrator::light
