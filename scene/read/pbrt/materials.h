// Materials and textures of a pbrt file -> those of the scene.
#pragma once

#include "scene/read/pbrt/lights.h"

namespace bnvpl::pbrt {

class Materials {
 public:
  Materials(const LightReader& reader, SceneBuilder& builder);
  ~Materials();

  // Begins to read the textures of a shape's material, so that they are there when all shapes are.
  void expect(const Shape& shape);
  // The number of its material, with its alpha and what it emits; kNone for an interface, which
  // is nothing to see.
  uint32_t of(const Shape& shape, const Emission& emission);
  // Notes the parameters of the materials and textures that were used which nobody asked for.
  void noteUnused() const;

 private:
  class Maker;
  std::unique_ptr<Maker> maker_;
};

}  // namespace bnvpl::pbrt
