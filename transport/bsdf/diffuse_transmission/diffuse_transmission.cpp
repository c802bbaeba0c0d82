#include "transport/bsdf/diffuse_transmission/diffuse_transmission.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

void addLobes(const DiffuseTransmissionModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out) {
  const Vec3 r = inputs.share(model.reflectance), t = inputs.share(model.transmittance);
  const float scale = 1.0f / std::max(1.0f, maxComponent(r + t));
  out.add(weight, LambertLobe{r * scale});
  out.add(weight, LambertLobe{t * scale, true});
}

ModelReport describe(const Scene&, const DiffuseTransmissionModel& m) {
  return {"diffuse transmission",
          {{"reflectance", m.reflectance}, {"transmittance", m.transmittance}}};
}

MtlModel toMtl(const Scene& scene, const DiffuseTransmissionModel& m) {
  return diffuseMtl(scene, m.reflectance);
}

}  // namespace bnvpl
