#include "transport/bsdf/diffuse/diffuse.h"

#include "transport/bsdf/lobe_sum.h"

namespace bnvpl {

void addLobes(const DiffuseModel& model, const MaterialInputs& inputs, Vec3 weight, LobeSum& out) {
  out.add(weight, LambertLobe{inputs.share(model.reflectance)});
}

}  // namespace bnvpl
