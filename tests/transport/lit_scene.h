// A scene with what its light is sampled by.
#pragma once

#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

struct Lit {
  Scene scene;
  RayScene rays;
  LightSet lights;
  explicit Lit(Scene s) : scene(std::move(s)), rays(scene), lights(rays) {}
};

}  // namespace bnvpl
