// A mix of two materials: the weighted sum of their lobes.
#pragma once

#include "transport/bsdf/lobe.h"

namespace bnvpl {

class LobeSum;
void addLobes(const MixModel& model, const MaterialInputs& inputs, Vec3 weight, LobeSum& out);

}  // namespace bnvpl
