// What the parameters of material models are made of: colours and numbers with textures, roughness,
// and the indices of metals. Each model is a header beside this one; cmake/MaterialModels.cmake
// makes the list of them.
//
// A model has kName, its name in scene files, and kHashId, its number in the hash of a scene, which
// never changes and is that of no other model. kLobes is the largest number of lobes that it adds
// to a BSDF (transport/bsdf.h).
//
// A Colour or Scalar is a constant, times an expression over textures where `texture` is not kNone
// (scene/textures/expression.h). A format whose textures replace the constant sets it to 1. Faces
// without texture coordinates use the constant alone. Models clamp their parameters when they are
// evaluated: reflectances to 0..1, roughness to 0..1, indices of refraction to 0.01..100 (of
// coats: 1..100, of conductors: 0..100), thickness to 0..100. Constants must be finite.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include "core/vec3.h"
#include "scene/textures/texture.h"

namespace bnvpl {

struct Colour {
  Vec3 value;
  uint32_t texture = kNone;  // into Scene::expressions
  Colour() = default;
  Colour(Vec3 v, uint32_t t = kNone) : value(v), texture(t) {}
};
struct Scalar {
  float value = 0.0f;
  uint32_t texture = kNone;  // into Scene::expressions; its first channel is used
  Scalar() = default;
  Scalar(float v, uint32_t t = kNone) : value(v), texture(t) {}
};

// Roughness along the surface's tangent (the direction of increasing u) and across it. A surface
// with alpha below 1e-3 is perfectly smooth.
struct Roughness {
  enum class Alpha : uint32_t {
    Same,    // alpha = roughness (pbrt with remaproughness false)
    Square,  // alpha = roughness^2 (glTF, Disney)
    Root     // alpha = sqrt(roughness) (pbrt with remaproughness true)
  };
  Scalar along, across;
  Alpha alpha = Alpha::Same;
  Roughness() = default;
  explicit Roughness(Scalar both, Alpha a = Alpha::Same) : along(both), across(both), alpha(a) {}
  Roughness(Scalar x, Scalar y, Alpha a) : along(x), across(y), alpha(a) {}
};

// The complex index of refraction of a metal, eta + i k, for each of red, green and blue. With
// `byReflectance` it follows from the reflectance at normal incidence: eta = 1, and k solves for it
// (pbrt).
struct ConductorFresnel {
  Colour eta{Vec3(0.2f, 0.92f, 1.1f)}, k{Vec3(3.91f, 2.45f, 2.14f)};
  bool byReflectance = false;
  Colour reflectance{Vec3(0.9f)};
};

template <typename Field>
inline constexpr bool kTextured = std::same_as<Field, Colour> || std::same_as<Field, Scalar>;
template <typename T, typename Plain>
concept Like = std::same_as<std::remove_const_t<T>, Plain>;

// forEachField(object, fn) calls fn(name, field) for each parameter of a model or of a part of one,
// in a fixed order. The field is a reference to a Colour, Scalar, bool, Roughness::Alpha or, in a
// mix, the number of a material.
template <Like<Roughness> M, typename Fn>
void forEachField(M& r, const std::array<const char*, 3>& names, const Fn& fn) {
  fn(names[0], r.along);
  fn(names[1], r.across);
  fn(names[2], r.alpha);
}
inline constexpr std::array<const char*, 3> kRoughnessNames{"roughness_along", "roughness_across",
                                                            "roughness_to_alpha"};
template <Like<ConductorFresnel> M, typename Fn>
void forEachField(M& f, const Fn& fn) {
  fn("eta", f.eta);
  fn("k", f.k);
  fn("reflectance", f.reflectance);
  fn("by_reflectance", f.byReflectance);
}

}  // namespace bnvpl
