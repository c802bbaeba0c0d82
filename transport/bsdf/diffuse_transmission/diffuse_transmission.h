// Paper, leaves, curtains: Lambert on both sides.
#pragma once

#include "transport/bsdf/diffuse/diffuse.h"

namespace bnvpl {

void addLobes(const DiffuseTransmissionModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out);
ModelReport describe(const Scene& scene, const DiffuseTransmissionModel& model);
MtlModel toMtl(const Scene& scene, const DiffuseTransmissionModel& model);

}  // namespace bnvpl
