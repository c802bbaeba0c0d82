// Point, spot and directional lights behind glass: shadow rays end at the glass, and no other ray
// can hit such a light. Photons carry its light to surfaces that the camera sees directly, and no
// integrator finds it where the camera sees them over a mirror or through glass.
#pragma once

#include <string>
#include <string_view>

#include "transport/lights/lights.h"

namespace bnvpl {

// Returns a warning if an integrator misses light in a scene with such lights and with surfaces
// that let light through, else an empty string.
std::string lightMissedInGlass(const Scene& scene, const LightSet& lights,
                               std::string_view integrator);

}  // namespace bnvpl
