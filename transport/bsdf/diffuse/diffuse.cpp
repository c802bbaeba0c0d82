#include "transport/bsdf/diffuse/diffuse.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

void addLobes(const DiffuseModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  out.add(weight, LambertLobe{inputs.share(model.reflectance)});
}

ModelReport describe(const Scene&, const DiffuseModel& m) {
  return {"diffuse", {{"reflectance", m.reflectance}}};
}

MtlModel toMtl(const Scene& scene, const DiffuseModel& m) {
  return diffuseMtl(scene, m.reflectance);
}

}  // namespace bnvpl
