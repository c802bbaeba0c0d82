// What surfaces are made of. A Material is one of the models below, with what all models share:
// emission, opacity, and relief (normal map or bump map).
//
// Parameters. A Colour or Scalar is a constant times, where `texture` is not kNone, an expression
// over textures (scene/textures/expression.h): a file format whose textures replace the constant
// sets it to 1. Where a face has no texture coordinates the constant counts alone. What a model
// cannot use is clamped when it is evaluated: reflectances to 0..1, roughness to 0..1, indices of
// refraction to 1..100 (of conductors: 0..100). Constants must be finite.
//
// Both sides of a surface look alike but for dielectrics, whose inside is behind the face's
// winding, and for emission. transport/bsdf/<model>/theory.md has each model's equations.
//
// Which light VPLs carry (LobeGroup, transport/bsdf.h) follows from alpha, the GGX roughness:
// reflection from lobes with alpha >= 0.3, in both directions of an anisotropic one, is "rough",
// and all other light, and all that crosses a surface, is "specular".
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
  uint32_t texture = kNone;  // into Scene::expressions; its first channel counts
  Scalar() = default;
  Scalar(float v, uint32_t t = kNone) : value(v), texture(t) {}
};

// Roughness along the surface's tangent (the direction of growing u) and across it. Alpha below
// 1e-3 counts as perfectly smooth.
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

// MTL as it always was: Lambert, plus a Phong lobe or a perfect mirror; or smooth glass.
// docs/scene-format.md says how the fields of an MTL are read.
struct PhongModel {
  Vec3 diffuse;                // Kd
  Vec3 glossy;                 // Ks of a Phong lobe; 0 for mirror and glass
  float exponent = 10.0f;      // Ns of that lobe
  Vec3 mirror;                 // Ks of a perfect mirror, or of glass; never beside a Phong lobe
  bool glass = false;          // smooth dielectric
  float ior = 1.5f;            // Ni
  Vec3 transmission{1, 1, 1};  // Tf
  uint32_t diffuseMap = kNone, glossyMap = kNone;  // into Scene::textures, not expressions
};

// Lambert. pbrt: diffuse.
struct DiffuseModel {
  Colour reflectance{Vec3(0.5f)};
};

// Lambert on both sides; reflectance + transmittance is scaled down to 1. pbrt:
// diffusetransmission.
struct DiffuseTransmissionModel {
  Colour reflectance{Vec3(0.25f)}, transmittance{Vec3(0.25f)};
};

// The complex index of refraction of a metal, per channel, as red, green and blue see it; or, where
// `byReflectance`, the reflectance at normal incidence, taken for eta = 1 and the k that gives it
// (pbrt).
struct ConductorFresnel {
  Colour eta{Vec3(0.2f, 0.92f, 1.1f)}, k{Vec3(3.91f, 2.45f, 2.14f)};
  bool byReflectance = false;
  Colour reflectance{Vec3(0.9f)};
};

// GGX metal. pbrt: conductor.
struct ConductorModel {
  ConductorFresnel fresnel;
  Roughness roughness{Scalar(0.1f)};
  // Adds what scatters more than once between microfacets (Kulla & Conty 2017). pbrt and Cycles'
  // plain GGX leave it out.
  bool multipleScattering = true;
};

// GGX interface between outside (before the face's winding) and inside. pbrt: dielectric,
// thindielectric.
struct DielectricModel {
  Scalar ior{1.5f};  // of the inside, against the outside
  Roughness roughness{Scalar(0.0f)};
  Colour reflection{Vec3(1)}, transmission{Vec3(1)};  // tints, which physics leaves at 1
  // A sheet with parallel sides: light goes straight on, all bounces within are summed. Always
  // smooth.
  bool thin = false;
};

// Lambert below a dielectric coat. pbrt: coateddiffuse (whose thickness is then 0 and medium
// empty).
struct CoatedDiffuseModel {
  Colour reflectance{Vec3(0.5f)};  // of the base without coat
  Scalar ior{1.5f};                // of the coat
  Roughness roughness{Scalar(0.0f)};
};

// GGX metal below a dielectric coat. pbrt: coatedconductor.
struct CoatedConductorModel {
  ConductorFresnel fresnel;  // against vacuum: the coat's index is taken into account by the model
  Roughness roughness{Scalar(0.0f)};
  Scalar coatIor{1.5f};
  Roughness coatRoughness{Scalar(0.0f)};
};

// glTF 2.0, appendix B, with KHR_materials_ior, _specular, _clearcoat and _transmission (thin
// walls). alpha = roughness^2. Name the channels in the textures' expressions: metallic Blue,
// roughness Green, specular Alpha, clearcoat Red, clearcoatRoughness Green, transmission Red.
struct MetallicRoughnessModel {
  Colour baseColour{Vec3(1)};
  Scalar metallic{1.0f}, roughness{1.0f};
  // Disney's: alpha is roughness^2 / a along growing u and roughness^2 a across, a^2 = 1 - 0.9
  // anisotropy.
  Scalar anisotropy{0.0f};
  Scalar anisotropyTurns{0.0f};  // of that direction, anticlockwise as seen from outside; 1: full
  Scalar ior{1.5f};              // 0: reflects all, as the extension has it
  Scalar specular{1.0f};
  Colour specularColour{Vec3(1)};
  Scalar clearcoat{0.0f}, clearcoatRoughness{0.0f};
  Scalar transmission{0.0f};
};

// Two materials of Scene::materials side by side, finer than is seen: (1 - amount) of `first` and
// `amount` of `second`. Both have smaller numbers than the mix, which takes their models and
// nothing else of them; neither has the PhongModel. Mixes of mixes hold at most kMaxLobes lobes:
// the rest is black.
struct MixModel {
  uint32_t first = kNone, second = kNone;
  Scalar amount{0.5f};
};

using MaterialModel = std::variant<PhongModel, DiffuseModel, DiffuseTransmissionModel,
                                   ConductorModel, DielectricModel, CoatedDiffuseModel,
                                   CoatedConductorModel, MetallicRoughnessModel, MixModel>;

// Shading normals of relief. At most one of the two maps. They bend where light goes, never the
// side that a surface is seen from; seen from behind, the same relief counts
// (transport/shading_frame.h).
struct Relief {
  // Tangent-space normals as colours, linear (TextureUse::srgb false): n = 2 colour - 1, x along
  // growing u, y along growing v (v up), z outwards; `strength` scales x and y.
  uint32_t normalMap = kNone;  // into Scene::expressions
  // Height along the outward normal: its first channel times `strength`, in scene units, or, as in
  // MTL, in texels of the finest image: slopes then do not depend on how far it is stretched.
  uint32_t bumpMap = kNone;
  bool heightInTexels = false;
  float strength = 1.0f;
  bool flat() const { return normalMap == kNone && bumpMap == kNone; }
};

struct Material {
  std::string name;
  MaterialModel model;

  // Radiance, W/(m2 sr), on the side of the winding, or both; a texture scales it.
  Vec3 emission;
  uint32_t emissionTexture = kNone;  // into Scene::expressions
  bool twoSidedEmission = false;

  // Below the cutoff the surface is not there, for every kind of ray; opacity 0 makes what pbrt
  // calls an interface. opacityMap: the mask of a texture (TextureUse::mask), into Scene::textures;
  // opacityTexture: into Scene::expressions. Both multiply.
  float opacity = 1.0f, opacityCutoff = 0.5f;
  uint32_t opacityMap = kNone, opacityTexture = kNone;
  bool masked() const {
    return opacityMap != kNone || opacityTexture != kNone || opacity < opacityCutoff;
  }

  Relief relief;
  // Of a clearcoat, which `relief` leaves as smooth as the mesh is.
  Relief coatRelief;

  // Of a material that is known to be one: the loaders of MTL and tests.
  PhongModel& phong() { return std::get<PhongModel>(model); }
  const PhongModel& phong() const { return std::get<PhongModel>(model); }
};

}  // namespace bnvpl
