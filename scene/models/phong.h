// The model of MTL: Lambertian reflection plus a Phong lobe or a perfect mirror; or smooth glass.
// docs/scene-format.md says how the fields of an MTL are read.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct PhongModel {
  static constexpr const char* kName = "phong";
  static constexpr uint32_t kHashId = 0;
  static constexpr uint32_t kLobes = 3;
  Vec3 diffuse;                // Kd
  Vec3 glossy;                 // Ks of a Phong lobe; 0 for mirror and glass
  float exponent = 10.0f;      // Ns of the Phong lobe
  Vec3 mirror;                 // Ks of a perfect mirror or of glass; 0 if there is a Phong lobe
  bool glass = false;          // smooth dielectric
  float ior = 1.5f;            // Ni
  Vec3 transmission{1, 1, 1};  // Tf
  uint32_t diffuseMap = kNone, glossyMap = kNone;  // into Scene::textures, not expressions
};

// MTL has its own names for the fields.
template <Like<PhongModel> M, typename Fn>
void forEachField(M&, const Fn&) {}

}  // namespace bnvpl
