// The directions that lobes are computed in: about a shading normal, bent where it has to be.
#pragma once

#include "transport/bsdf/scatter.h"

namespace bnvpl {

// Whether the shading normal serves lobes seen from wo as it is: that and its mirror image lie
// above the surface.
bool keepsNormal(Vec3 ng, Vec3 ns, Vec3 wo);

struct LobeFrame {
  Vec3 x, y, z;  // z: the shading normal, bent where wo's mirror image needs it
  Vec3 wo;       // local, z > 0
  Vec3 ns;       // the shading normal as it is: light must come from its side of the surface
  float turns = 0.0f;

  LobeFrame() = default;
  // x is the tangent of the point turned about the normal, anticlockwise as seen from wo's side;
  // 1 is a full turn.
  LobeFrame(const SurfacePoint& point, Vec3 shadingNormal, float turned);

  bool bent() const { return z != ns; }
  Vec3 toLocal(Vec3 w) const { return {dot(w, x), dot(w, y), dot(w, z)}; }
  Vec3 toWorld(Vec3 w) const { return w.x * x + w.y * y + w.z * z; }
  // The mirror image of wo, around which lobes lie.
  Vec3 mirrorAxis() const { return reflect(toWorld(wo), z); }
};

}  // namespace bnvpl
