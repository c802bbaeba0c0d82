// Converts the materials and textures of a pbrt file.
#pragma once

#include "scene/read/pbrt/lights.h"

namespace bnvpl::pbrt {

class Materials {
 public:
  Materials(const LightReader& reader, SceneBuilder& builder);
  ~Materials();

  // Starts to decode the textures of a shape's material while shapes are read.
  void expect(const Shape& shape);
  // The number of the shape's material with its alpha and emission; kNone for an interface.
  uint32_t of(const Shape& shape, const ShapeEmission& emission);
  // Notes the parameters that no reader used, of all materials and textures in use.
  void noteUnused() const;

 private:
  class Maker;
  std::unique_ptr<Maker> maker_;
};

}  // namespace bnvpl::pbrt
