#include "transport/bsdf/diffuse/diffuse.h"

#include "transport/bsdf.h"

namespace bnvpl {

void addLobes(const DiffuseModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  out.add(weight, LambertLobe{inputs.share(model.reflectance)});
}

}  // namespace bnvpl
