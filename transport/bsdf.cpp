#include "transport/bsdf.h"

#include <algorithm>

namespace bnvpl {

namespace {

// Constructs the model in place, because a LobeSum is large.
std::variant<PhongBsdf, LobeSum> makeModel(const Scene& scene, const SurfacePoint& point) {
  using Made = std::variant<PhongBsdf, LobeSum>;
  const MaterialModel& model = scene.materials[point.material].model;
  if (const auto* phong = std::get_if<PhongModel>(&model))
    return Made(std::in_place_type<PhongBsdf>, scene, *phong, point);
  return Made(std::in_place_type<LobeSum>, scene, model, point);
}

}  // namespace

// With textures, any model except Lambert's may be specular somewhere.
bool mayBeSpecular(const Material& m) {
  if (const auto* phong = std::get_if<PhongModel>(&m.model)) return hasSpecularLobes(*phong);
  return !std::holds_alternative<DiffuseModel>(m.model);
}

bool hasSpecularLobes(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), mayBeSpecular);
}

Bsdf::Bsdf(const Scene& scene, const SurfacePoint& point)
    : point_(point), model_(makeModel(scene, point)) {}

bool Bsdf::sample(LobeGroup group, Transport transport, Rng& rng, BsdfSample& out) const {
  if (const auto* phong = std::get_if<PhongBsdf>(&model_))
    return phong->sample(point_, group, transport, rng, out);
  const float pick = rng.next();
  return sample(group, transport, pick, rng.nextPoint(), out);
}

}  // namespace bnvpl
