// Light of points, spots and parallel beams that lies behind glass: shadow rays end at the glass,
// and no other ray can meet such a light. Photons bring it to what the camera sees directly.
#pragma once

#include <string>
#include <string_view>

#include "transport/lights.h"

namespace bnvpl {

// A warning where an integrator misses such light in a scene that has such lights and surfaces that
// let light through; empty where it does not.
std::string lightMissedInGlass(const Scene& scene, const LightSet& lights,
                               std::string_view integrator);

}  // namespace bnvpl
