// Path tracing: the reference.
#include <array>
#include <memory>

#include "tools/render/integrator/path_tracer.h"

namespace bnvpl::methods::integrator::path {

namespace {

constexpr std::array kOptions{kMaxBouncesOption};

Integrator make(const IntegratorInputs& in, const Values& options) {
  const auto tracer =
      std::make_shared<const PathTracer>(in.rays, in.lights, maxBouncesOf(options), in.only);
  return {[tracer](const TileSamples& tile) { tracer->render(tile); }};
}

}  // namespace

extern const IntegratorMethod method;
const IntegratorMethod method{"path", "path tracing, the reference; takes no VPLs", kOptions, make};

}  // namespace bnvpl::methods::integrator::path
