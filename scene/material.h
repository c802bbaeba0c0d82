// Materials of surfaces. A Material is one of the models below plus what all models share:
// emission, opacity, and relief (a normal map or bump map).
//
// Parameters. A Colour or Scalar is a constant, times an expression over textures where `texture`
// is not kNone (scene/textures/expression.h). A format whose textures replace the constant sets it
// to 1. Faces without texture coordinates use the constant alone. Models clamp their parameters
// when they are evaluated: reflectances to 0..1, roughness to 0..1, indices of refraction to 1..100
// (of conductors: 0..100). Constants must be finite.
//
// Both sides of a surface scatter alike, except for dielectrics, whose inside is the side opposite
// to the winding. Emission has its own sides. transport/bsdf/<model>/theory.md has each model's
// equations.
//
// Alpha, the GGX roughness, decides which light VPLs carry (LobeGroup, transport/bsdf.h).
// Reflection from lobes with alpha >= 0.3, in both directions of an anisotropic one, is "rough".
// All other reflection, and all light that crosses a surface, is "specular".
#pragma once

#include <cstdint>
#include <string>
#include <variant>

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

// The model of MTL: Lambertian reflection plus a Phong lobe or a perfect mirror; or smooth glass.
// docs/scene-format.md says how the fields of an MTL are read.
struct PhongModel {
  Vec3 diffuse;                // Kd
  Vec3 glossy;                 // Ks of a Phong lobe; 0 for mirror and glass
  float exponent = 10.0f;      // Ns of the Phong lobe
  Vec3 mirror;                 // Ks of a perfect mirror or of glass; 0 if there is a Phong lobe
  bool glass = false;          // smooth dielectric
  float ior = 1.5f;            // Ni
  Vec3 transmission{1, 1, 1};  // Tf
  uint32_t diffuseMap = kNone, glossyMap = kNone;  // into Scene::textures, not expressions
};

// Lambertian reflection; pbrt's `diffuse`.
struct DiffuseModel {
  Colour reflectance{Vec3(0.5f)};
};

// Lambertian reflection and transmission; pbrt's `diffusetransmission`. Where reflectance +
// transmittance exceeds 1, both are scaled down.
struct DiffuseTransmissionModel {
  Colour reflectance{Vec3(0.25f)}, transmittance{Vec3(0.25f)};
};

// The complex index of refraction of a metal, eta + i k, for each of red, green and blue. With
// `byReflectance` it follows from the reflectance at normal incidence: eta = 1, and k solves for it
// (pbrt).
struct ConductorFresnel {
  Colour eta{Vec3(0.2f, 0.92f, 1.1f)}, k{Vec3(3.91f, 2.45f, 2.14f)};
  bool byReflectance = false;
  Colour reflectance{Vec3(0.9f)};
};

// GGX metal; pbrt's `conductor`.
struct ConductorModel {
  ConductorFresnel fresnel;
  Roughness roughness{Scalar(0.1f)};
  // Adds the energy that scatters more than once between microfacets (Kulla & Conty 2017). pbrt and
  // Cycles' plain GGX omit it.
  bool multipleScattering = true;
};

// GGX interface between the outside, on the side of the winding, and the inside; pbrt's
// `dielectric` and `thindielectric`.
struct DielectricModel {
  Scalar ior{1.5f};  // index of the inside relative to the outside
  Roughness roughness{Scalar(0.0f)};
  Colour reflection{Vec3(1)}, transmission{Vec3(1)};  // tints; the physical value is 1
  // A sheet with parallel faces, always smooth. Light passes straight through, and the series of
  // internal reflections is summed.
  bool thin = false;
};

// Lambertian base below a dielectric coat; pbrt's `coateddiffuse` with thickness 0 and no medium.
struct CoatedDiffuseModel {
  Colour reflectance{Vec3(0.5f)};  // albedo of the base without the coat
  Scalar ior{1.5f};                // index of the coat
  Roughness roughness{Scalar(0.0f)};
};

// GGX metal below a dielectric coat; pbrt's `coatedconductor`.
struct CoatedConductorModel {
  ConductorFresnel fresnel;  // relative to vacuum; the model divides by the coat's index
  Roughness roughness{Scalar(0.0f)};
  Scalar coatIor{1.5f};
  Roughness coatRoughness{Scalar(0.0f)};
};

// glTF 2.0, appendix B, with KHR_materials_ior, _specular, _clearcoat and _transmission (thin
// walls). alpha = roughness^2. The textures' expressions must select the channels: metallic Blue,
// roughness Green, specular Alpha, clearcoat Red, clearcoatRoughness Green, transmission Red.
struct MetallicRoughnessModel {
  Colour baseColour{Vec3(1)};
  Scalar metallic{1.0f}, roughness{1.0f};
  // Disney's anisotropy: alpha is roughness^2 / a along increasing u and roughness^2 a across it,
  // a^2 = 1 - 0.9 anisotropy.
  Scalar anisotropy{0.0f};
  Scalar anisotropyTurns{0.0f};  // rotation of that direction in turns, anticlockwise from outside
  Scalar ior{1.5f};              // 0 means total reflection, as in KHR_materials_ior
  Scalar specular{1.0f};
  Colour specularColour{Vec3(1)};
  Scalar clearcoat{0.0f}, clearcoatRoughness{0.0f};
  Scalar transmission{0.0f};
};

// A linear blend of two of Scene::materials: (1 - amount) of `first` plus `amount` of `second`.
// Both have smaller numbers than the mix, which uses nothing but their models. Mixes of mixes hold
// at most kMaxLobes lobes; further lobes are black.
struct MixModel {
  uint32_t first = kNone, second = kNone;
  Scalar amount{0.5f};
};

using MaterialModel = std::variant<PhongModel, DiffuseModel, DiffuseTransmissionModel,
                                   ConductorModel, DielectricModel, CoatedDiffuseModel,
                                   CoatedConductorModel, MetallicRoughnessModel, MixModel>;

// Shading normals from at most one of two maps. They bend scattered light but never decide which
// side of the surface is seen. Both sides have the same relief (transport/shading_frame.h).
struct Relief {
  // Tangent-space normals as colours, linear (TextureUse::srgb false): n = 2 colour - 1, x along
  // increasing u, y along increasing v (v up), z outwards; `strength` scales x and y.
  uint32_t normalMap = kNone;  // into Scene::expressions
  // Height along the outward normal: the first channel times `strength`, in scene units. As in MTL,
  // it may be in texels of the finest image: slopes then do not depend on how far it is stretched.
  uint32_t bumpMap = kNone;
  bool heightInTexels = false;
  float strength = 1.0f;
  bool flat() const { return normalMap == kNone && bumpMap == kNone; }
};

struct Material {
  std::string name;
  MaterialModel model;

  // Emitted radiance, W/(m2 sr), on the side of the winding or on both; a texture scales it.
  Vec3 emission;
  uint32_t emissionTexture = kNone;  // into Scene::expressions
  bool twoSidedEmission = false;

  // Where the opacity is below the cutoff, the surface is absent for every kind of ray; opacity 0
  // makes what pbrt calls an interface. `opacityMap`, the mask of a texture (TextureUse::mask) in
  // Scene::textures, and `opacityTexture`, in Scene::expressions, both multiply the opacity.
  float opacity = 1.0f, opacityCutoff = 0.5f;
  uint32_t opacityMap = kNone, opacityTexture = kNone;
  bool masked() const {
    return opacityMap != kNone || opacityTexture != kNone || opacity < opacityCutoff;
  }

  Relief relief;
  // Relief of the clearcoat, to which `relief` does not apply.
  Relief coatRelief;

  // The material must hold a PhongModel.
  PhongModel& phong() { return std::get<PhongModel>(model); }
  const PhongModel& phong() const { return std::get<PhongModel>(model); }
};

}  // namespace bnvpl
