// Surfaces that are partly there, in proportion to an opacity between 0 and 1.
#pragma once

#include "scene/scene_builder.h"

namespace bnvpl {

// Makes `m`, which must not have the PhongModel, a mix: `amount` of its model beside what lets all
// light straight through, but for shadow rays.
void addTransparency(Scalar amount, SceneBuilder& builder, Material& m);

}  // namespace bnvpl
