#include "scene/read/see_through.h"

namespace bnvpl {

void addTransparency(Scalar amount, SceneBuilder& builder, Material& m) {
  Material clear;
  clear.name = m.name + " (clear)";
  DielectricModel nothing;
  nothing.ior = 1.0f;
  nothing.thin = true;
  clear.model = nothing;
  Material solid;
  solid.name = m.name + " (solid)";
  solid.model = m.model;
  m.model = MixModel{builder.addMaterial(clear), builder.addMaterial(solid), amount};
}

}  // namespace bnvpl
