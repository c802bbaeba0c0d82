// Albedo and normal for denoisers, by the conventions of Open Image Denoise ("RT", albedo and
// normal images): those of the first vertex that is not perfectly specular.
#pragma once

#include "core/random.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// Both are 0 where a ray leaves the scene.
struct DenoiserFeatures {
  Vec3 albedo;  // share of the light that the surface reflects or transmits, 0..1
  Vec3 normal;  // shading normal, in world space; shorter than 1 where several are averaged
  DenoiserFeatures& operator+=(const DenoiserFeatures& other) {
    albedo += other.albedo, normal += other.normal;
    return *this;
  }
};

// Features of a camera ray that hit `first`. Perfect mirrors and glass show those of what they
// reflect and transmit, at random by Fresnel; a perfectly smooth coat adds what it reflects to the
// albedo of its base. Normals keep their full length: a coat and its base share it.
DenoiserFeatures denoiserFeatures(const Accelerator& accel, const SurfacePoint& first, Rng& rng);

}  // namespace bnvpl
