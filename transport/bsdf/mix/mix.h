// A mix of two materials: the weighted sum of their lobes.
#pragma once

#include "transport/bsdf/lobe.h"

namespace bnvpl {

bool isGlass(const MixModel& model, const Scene& scene);

class Bsdf;
void addLobes(const MixModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);

}  // namespace bnvpl
