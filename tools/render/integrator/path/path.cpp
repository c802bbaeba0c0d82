// Path tracing: the reference.
#include <array>
#include <memory>

#include "tools/render/integrator/path_tracer.h"

namespace bnvpl::methods::integrator::path {

namespace {

constexpr auto kLightSamplingOption =
    switchOption("light-sampling", "on",
                 "shadow rays to all lights; off: only to lights that no BSDF ray can hit");
constexpr auto kFirefliesOption = firefliesOption("keep");
constexpr auto kOptions = optionTable(kMaxBouncesOption, kLightSamplingOption, kFirefliesOption);

struct Parts {
  LightSet lights;
  PathTracer tracer;
  Parts(const IntegratorInputs& in, const Values& options)
      : lights(options[kLightSamplingOption] ? in.lights : in.lights.onlyUnhittable()),
        tracer(in.accel, lights, maxBouncesOf(options), in.shown) {}
};

Integrator make(const IntegratorInputs& in, const Values& options) {
  const auto parts = std::make_shared<const Parts>(in, options);
  return {[parts](const TileSamples& tile) { parts->tracer.render(tile); }};
}

}  // namespace

extern const IntegratorMethod method{"path", "path tracing, the reference; takes no VPLs", kOptions,
                                     make};

}  // namespace bnvpl::methods::integrator::path
