// A scene with what its light is sampled by.
#pragma once

#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"

namespace bnvpl {

struct Lit {
  Scene scene;
  Accelerator accel;
  LightSet lights;
  explicit Lit(Scene s) : scene(std::move(s)), accel(scene), lights(accel) {}
};

}  // namespace bnvpl
