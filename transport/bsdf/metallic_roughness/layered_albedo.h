// Directional albedo of a white Lambert base below glTF's specular layer (theory.md, eq. 3 and 4):
// the fraction of the light from a direction that leaves by the base.
#pragma once

namespace bnvpl {

// Arguments are 0..1; the result is within 0.01 of the integral. The table is made at first use.
float layeredAlbedo(float cosine, float f0, float f90, float alpha);

}  // namespace bnvpl
