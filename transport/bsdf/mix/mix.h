// A mix of two materials: the weighted sum of their lobes.
#pragma once

#include "transport/bsdf/lobe.h"

namespace bnvpl {

bool isGlass(const MixModel& model, const Scene& scene);

void addLobes(const MixModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);
ModelReport describe(const Scene& scene, const MixModel& model);
MtlModel toMtl(const Scene& scene, const MixModel& model);

}  // namespace bnvpl
