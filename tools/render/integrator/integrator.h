// The methods of --integrator, which find the radiance along camera rays. Each is a folder beside
// this file.
#pragma once

#include <span>

#include "core/cost_probe.h"
#include "core/progress.h"
#include "formats/vpl_table.h"
#include "tools/common/method.h"
#include "tools/render/film/integrator.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

// Borrowed until the image is done.
struct IntegratorInputs {
  const RayScene& rays;
  const LightSet& lights;
  const VplTable& lit;  // stage Lit; empty unless the method needs VPLs
  uint64_t seed;
  Only only;
  const ProgressFn& progress;  // of preparations
  CostProbe* probe = nullptr;  // where nothing but the cost is asked for

  uint64_t pixels() const {
    const Film& film = rays.scene().film;
    return probe ? probe->pixels : uint64_t{film.width} * film.height;
  }
};

// For integrators that find light by camera samples.
constexpr Option firefliesOption(std::string_view fallback) {
  return choiceOption("fireflies", fallback, "redistribute|keep",
                      "samples and photons far brighter than all around them: their excess goes "
                      "to the surface around, with its energy, or stays");
}

// False for methods without the option.
inline bool redistributesFireflies(const Values& options) {
  return options.has("fireflies") && options.text("fireflies") == "redistribute";
}

struct IntegratorMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  Integrator (*make)(const IntegratorInputs&, const Values&);
  bool needsVpls = false;
  bool photons = false;  // sends photons for indirect light
  bool gathers = false;  // gathers VPLs: --gather and --compensate count
};
std::span<const IntegratorMethod* const> integratorMethods();

}  // namespace bnvpl
