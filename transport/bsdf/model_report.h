// What a model says of itself: to people (`vpl-inspect scene`), and to programs that read MTL. Each
// model's folder has the two functions for it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// The model's name and its parameters, in the order in which they are shown.
struct ModelReport {
  struct Image {
    Vec3 value;
    uint32_t image;  // into Scene::textures, not expressions
  };
  using Parameter = std::variant<Colour, Scalar, Image, bool, std::string>;
  std::string model;
  std::vector<std::pair<std::string, Parameter>> parameters;

  void add(const std::string& name, Parameter value) {
    parameters.emplace_back(name, std::move(value));
  }
  void add(const std::string& name, const Roughness& roughness);
  void add(const ConductorFresnel& fresnel);
};
ModelReport describeModel(const Scene& scene, const MaterialModel& model);

// The nearest material that MTL can state.
struct MtlModel {
  PhongModel phong;
  std::optional<MetallicRoughnessModel> facets;  // written beside Kd; specularColour holds f0
  bool exact = false;                            // whether MTL states all of the model
};
MtlModel modelToMtl(const Scene& scene, const MaterialModel& model);

// The nearest to Lambert's law, a metal, and glass.
MtlModel diffuseMtl(const Scene& scene, const Colour& reflectance);
MtlModel metalMtl(const ConductorFresnel& fresnel, const Roughness& roughness);
MtlModel glassMtl(float ior, Vec3 transmission);

}  // namespace bnvpl
