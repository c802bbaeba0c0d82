// Materials of surfaces. A Material is one of the models of scene/models plus what all models
// share: emission, opacity, and relief (a normal map or bump map).
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
#include "scene/material_models.h"
#include "scene/textures/texture.h"

namespace bnvpl {

// Shading normals from at most one of two maps. They bend scattered light but never decide which
// side of the surface is seen. Both sides have the same relief (transport/bump_mapping.h).
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
  MaterialModel model = PhongModel{};

  // Emitted radiance, W/(m2 sr), on the side of the winding or on both; a texture scales it.
  Vec3 emission;
  uint32_t emissionTexture = kNone;  // into Scene::expressions
  bool twoSidedEmission = false;
  uint32_t lightGroup = 0;  // into Scene::lightGroups

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
