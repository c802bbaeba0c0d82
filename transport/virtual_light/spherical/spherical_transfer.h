// VPLs that are spheres (Hasan, Krivanek, Walter & Bala 2009, "Virtual Spherical Lights for
// Many-Light Rendering of Glossy Scenes").
//
// Such a VPL spreads its flux over the disk that its sphere shows, so that its light is the mean of
// BSDF and both cosines over the directions of the sphere:
//   transfer = 1/(pi r^2) * integral of f(w) (n_x.w) (-n_l.w)+ dw     over the sphere's cone
// A receiver inside of the sphere takes the hemisphere about its normal instead of the cone.
#pragma once

#include <cstdint>

#include "transport/bsdf.h"

namespace bnvpl {

struct VirtualSphericalLight {
  Vec3 toCentre;  // from the receiver
  Vec3 normal;    // on the lit side; unit, or the mean of unit normals
  float radius2;  // squared radius, > 0
};

// `value`: BSDF and cosines over the sphere, 1/m2, without intensity.
struct SphericalLightTransfer {
  Vec3 value;
  bool sampled;  // a mean of samples, no closed form
};

// Closed form where the receiver is diffuse and either no horizon cuts the cone or it lies in the
// sphere with a shading normal that is its geometric one; else the mean of samples, whose numbers
// depend on `key`.
SphericalLightTransfer sphericalTransfer(const VirtualSphericalLight& vpl, const Bsdf& bsdf,
                                         uint64_t key);

// The value by `samples` directions of the cone and, for a glossy receiver that sees a large
// sphere, as many of the BSDF, with MIS weights.
Vec3 sampledSphericalTransfer(const VirtualSphericalLight& vpl, const Bsdf& bsdf, unsigned samples,
                              uint64_t key);

}  // namespace bnvpl
