// Trials of single lights and of the camera by a few rays, for the doctor.
#pragma once

#include <cstdint>
#include <string>

#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"

namespace bnvpl {

// Where the photons of one light go.
struct LightTrial {
  Vec3 direction;  // mean direction of emission; its length is 1 for a beam, 0 for a globe
  double meetsAtOnce =
      0.0;              // share of photons whose first hit is within kAtOnce of the scene's size
  double leaves = 0.0;  // share that hits nothing
  double reachesView = 0.0;  // share of the power of which a diffuse hit is in sight of the camera
};
inline constexpr double kAtOnce = 0.01;
LightTrial tryLight(const Accelerator& accel, const LightSet& lights, size_t light,
                    uint64_t photons);

// Whether the camera sees a point, from the side that its geometric normal points to.
bool inSight(const Accelerator& accel, const SurfacePoint& point);

// What the camera sees, by a grid of rays through the film, and what is around it.
struct ViewTrial {
  double depth = 0.0;     // median distance of what the film shows, scene units; 0: nothing
  double open = 0.0;      // share of the film that shows no surface
  double behind = 0.0;    // share of the directions around the camera that meet a surface's back
  double closed = 0.0;    // share of these directions that meet a surface
  double touching = 0.0;  // share of the film that shows something within 1e-4 of the scene's size
};
ViewTrial tryView(const Accelerator& accel);

// "towards (0, -1, 0)", "in all directions".
std::string directionText(Vec3 direction);

}  // namespace bnvpl
