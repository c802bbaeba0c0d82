// How much of a scene's surface matters to the view, for the doctor.
#pragma once

#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// Share of the surface, by area, that the camera sees or that sees what the camera sees: there
// vpl-place puts VPLs. Estimated by a few thousand points, each with a few rays from both sides.
double shareInUse(const Accelerator& accel);

}  // namespace bnvpl
