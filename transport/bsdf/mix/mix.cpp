#include "transport/bsdf/mix/mix.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

bool isGlass(const MixModel& model, const Scene& scene) {
  return isGlass(scene, model.first) || isGlass(scene, model.second);
}

void addLobes(const MixModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  const float amount = inputs.share(model.amount);
  const auto add = [&](uint32_t part, float share) {
    if (part == kNone || share == 0.0f || out.full()) return;
    addModel(inputs.scene().materials[part].model, inputs, weight * share, out);
  };
  add(model.first, 1.0f - amount);
  add(model.second, amount);
}

ModelReport describe(const Scene& scene, const MixModel& m) {
  const auto name = [&](uint32_t part) { return part == kNone ? "" : scene.materials[part].name; };
  return {"mix", {{"first", name(m.first)}, {"second", name(m.second)}, {"amount", m.amount}}};
}

MtlModel toMtl(const Scene& scene, const MixModel& m) {
  const uint32_t part = m.amount.value < 0.5f ? m.first : m.second;
  MtlModel mtl = part != kNone ? modelToMtl(scene, scene.materials[part].model) : MtlModel{};
  mtl.exact = false;
  return mtl;
}

}  // namespace bnvpl
