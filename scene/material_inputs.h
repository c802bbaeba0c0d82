// The parameters of a material, one after the other, for what treats all models alike: hashes,
// checks, reports.
#pragma once

#include "scene/material.h"

namespace bnvpl {

// Calls fn with each Colour, Scalar, and number or switch of a model (Vec3, float, uint32_t), in a
// fixed order. Not of the PhongModel, nor the coat's relief.
template <typename Fn>
void forEachInput(const PhongModel&, const Fn&) {}
template <typename Fn>
void forEachInput(const Roughness& r, const Fn& fn) {
  fn(r.along);
  fn(r.across);
  fn(static_cast<uint32_t>(r.alpha));
}
template <typename Fn>
void forEachInput(const ConductorFresnel& f, const Fn& fn) {
  fn(f.eta);
  fn(f.k);
  fn(f.reflectance);
  fn(uint32_t{f.byReflectance});
}
template <typename Fn>
void forEachInput(const DiffuseModel& m, const Fn& fn) {
  fn(m.reflectance);
}
template <typename Fn>
void forEachInput(const DiffuseTransmissionModel& m, const Fn& fn) {
  fn(m.reflectance);
  fn(m.transmittance);
}
template <typename Fn>
void forEachInput(const ConductorModel& m, const Fn& fn) {
  forEachInput(m.fresnel, fn);
  forEachInput(m.roughness, fn);
  fn(uint32_t{m.multipleScattering});
}
template <typename Fn>
void forEachInput(const DielectricModel& m, const Fn& fn) {
  fn(m.ior);
  forEachInput(m.roughness, fn);
  fn(m.reflection);
  fn(m.transmission);
  fn(uint32_t{m.thin});
}
template <typename Fn>
void forEachInput(const CoatedDiffuseModel& m, const Fn& fn) {
  fn(m.reflectance);
  fn(m.ior);
  forEachInput(m.roughness, fn);
}
template <typename Fn>
void forEachInput(const CoatedConductorModel& m, const Fn& fn) {
  forEachInput(m.fresnel, fn);
  forEachInput(m.roughness, fn);
  fn(m.coatIor);
  forEachInput(m.coatRoughness, fn);
}
template <typename Fn>
void forEachInput(const MetallicRoughnessModel& m, const Fn& fn) {
  fn(m.baseColour);
  fn(m.specularColour);
  for (const Scalar& s : {m.metallic, m.roughness, m.anisotropy, m.ior, m.specular, m.clearcoat,
                          m.clearcoatRoughness, m.transmission, m.anisotropyTurns})
    fn(s);
}
template <typename Fn>
void forEachInput(const MixModel& m, const Fn& fn) {
  fn(m.first);
  fn(m.second);
  fn(m.amount);
}
template <typename Fn>
void forEachInput(const Material& m, const Fn& fn) {
  std::visit([&](const auto& model) { forEachInput(model, fn); }, m.model);
  for (const uint32_t number :
       {m.emissionTexture, m.opacityTexture, m.relief.normalMap, m.relief.bumpMap})
    fn(number);
}

// Calls fn with the number of each expression of a material, kNone for each there is none for.
template <typename Fn>
void forEachExpression(const Material& m, const Fn& fn) {
  struct Expressions {
    const Fn& fn;
    void operator()(const Colour& c) const { fn(c.texture); }
    void operator()(const Scalar& s) const { fn(s.texture); }
    void operator()(uint32_t) const {}
  };
  std::visit([&](const auto& model) { forEachInput(model, Expressions{fn}); }, m.model);
  for (const uint32_t number : {m.emissionTexture, m.opacityTexture, m.relief.normalMap,
                                m.relief.bumpMap, m.coatRelief.normalMap, m.coatRelief.bumpMap})
    fn(number);
}

}  // namespace bnvpl
