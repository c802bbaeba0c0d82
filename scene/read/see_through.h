// Surfaces of partial opacity, between 0 and 1.
#pragma once

#include "scene/builder/scene_builder.h"

namespace bnvpl {

// Turns `m` into a mix of `amount` of its model and a thin sheet of index 1, which light crosses
// unchanged. Shadow rays do not cross it.
void addTransparency(Scalar amount, SceneBuilder& builder, Material& m);

}  // namespace bnvpl
