// MIS of rays with photons that find the same light.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "transport/bsdf.h"
#include "transport/lights/lights.h"
#include "transport/photons/emission_guide.h"

namespace bnvpl {

// Identifies the emitter of photons: a light, or, in an environment image, a region of similar
// radiance such as the sun. Regions are classes of photon density, in steps of a factor of 4.
uint64_t emitterOf(const LightSet& lights, size_t light, Vec3 towards);

// MIS weights of rays for light that photons estimate, too.
//
// Caustics of the film: the power heuristic, for light through specular vertices. Densities are
// rays per area of the receiver and photons per area of the emitter. Rays have two techniques at
// the vertex next to the light, BSDF rays of density a and shadow rays of density a s, so that
//   w_photons = c^2 / (a^2 (1 + s^2) + c^2).
// The ratio of a and c is exact if the specular surfaces between are flat; otherwise the weights
// still sum to one.
//
// Flux of VPLs (misRatio > 0): the balance heuristic by the density g with which photons
// start on the path, relative to emission by power. Photons weigh g / (g + misRatio).
struct PhotonMis {
  const LightSet* lights = nullptr;  // null: there are no photons
  // BSDF rays per area, 1/unit^2, that took the specular lobes at all vertices so far.
  float rays = 0.0f;
  // Number of photons from all lights. With a misRatio only whether there are any matters.
  float photons = 0.0f;
  // Emitters (emitterOf) that emit photons, ascending; null: all do. Rays alone estimate the
  // others.
  const std::vector<uint64_t>* emitters = nullptr;
  const EmissionGuide* guide = nullptr;  // density of the photons; null: by power
  float misRatio = 0.0f;
  // The importance of rough lobes by which rays choose lobes at their first vertex (walk.h), or a
  // typical value of it.
  float roughImportance = 1.0f;
  // Whether shadow rays from the last vertex count.
  bool countsShadowRays = false;

  // The same for rays that go on by the specular lobes of a vertex, the first or a later one.
  PhotonMis beyond(const Bsdf& vertex, bool first) const;
  // Probability, known to both ends, with which rays take the specular lobes of a vertex. It is 1
  // for a surface that light crosses, whose far side photons do not see as rays do.
  static float sharedSpecularProbability(const Bsdf& vertex, float roughImportance);
  // The ratio s of the densities of shadow rays and BSDF rays, 1/sr.
  static float shadowRayRatio(float shadowRays, float bsdfRays);

  // Weight of rays that reach `from` from the direction `towards` a light. place() tells where on
  // the light: invertSample(). `shadowRays`: shadowRayRatio() at `from`.
  template <typename Place>
  float rayWeight(size_t light, Vec3 towards, Vec3 from, const Place& place,
                  float shadowRays) const {
    if (!sends(light, towards)) return 1.0f;
    if (!lights->photonsReach(light, towards, from)) return 1.0f;
    if (!lights->hittable(light) && !(misRatio > 0.0f)) return 0.0f;
    const float guided =
        guide && guide->guides()
            ? guide->density({static_cast<uint32_t>(light),
                              lights->invertEmission(light, place(), towards, from)})
            : 1.0f;
    return rayWeight(light, towards, guided, countsShadowRays ? shadowRays : 0.0f);
  }
  // The same with the density of the photons relative to emission by power.
  float rayWeight(size_t light, Vec3 towards, float guided, float shadowRays) const;

 private:
  // Whether photons carry light of the emitter.
  bool sends(size_t light, Vec3 towards) const;
};

}  // namespace bnvpl
