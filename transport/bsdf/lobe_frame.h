// Local frames in which lobes are evaluated, about a shading normal that is bent where necessary.
#pragma once

#include "transport/bsdf/bsdf_sample.h"

namespace bnvpl {

// Whether lobes seen from wo can use ns unbent: wo lies above its horizon, and the mirror image of
// wo above the geometric surface.
bool keepsNormal(Vec3 ng, Vec3 ns, Vec3 wo);

struct LobeFrame {
  Vec3 x, y, z;  // z: the shading normal, bent where keepsNormal() is false
  Vec3 wo;       // local, z > 0
  Vec3 ns;       // the unbent shading normal, on whose side the light must be
  float turns = 0.0f;

  LobeFrame() = default;
  // x is the point's tangent after `turned` full turns about the normal, anticlockwise as seen from
  // wo's side.
  LobeFrame(const SurfacePoint& point, Vec3 shadingNormal, float turned);

  bool bent() const { return z != ns; }
  Vec3 toLocal(Vec3 w) const { return {dot(w, x), dot(w, y), dot(w, z)}; }
  Vec3 toWorld(Vec3 w) const { return w.x * x + w.y * y + w.z * z; }
  // The mirror image of wo, the axis of glossy lobes.
  Vec3 mirrorAxis() const { return reflect(toWorld(wo), z); }
};

}  // namespace bnvpl
