// All lights of a scene behind one set of questions: emissive triangles (one light for each
// emissive material), and the lights of scene.toml. Power in W, linear sRGB.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/cdf.h"
#include "core/random.h"
#include "core/sampling.h"
#include "transport/emission_grid.h"
#include "transport/rays.h"

namespace bnvpl {

// A light seen from a point: a direction and what arrives from it, ready for a shadow ray.
struct DirectSample {
  Vec3 wi;                // unit, towards the light
  Vec3 radianceOverPdf;   // radiance / density; for point-like lights the irradiance on a facing
                          // surface
  float pdf = 0.0f;       // of wi in 1/sr, given the light; 0 for lights that no ray can hit
  bool infinite = false;  // the shadow ray never ends
  Vec3 target;            // else it ends here, offset off the emitter
};

struct PhotonStart {
  Vec3 origin;     // offset
  Vec3 direction;  // unit
  Vec3 flux;       // W, as if this were the only photon of its light
};

class LightSet {
 public:
  // Throws InputError where floats do not hold the power of a light.
  explicit LightSet(const RayScene& rays);

  size_t size() const { return lights_.size(); }
  Vec3 power(size_t light) const { return lights_[light].power; }
  Vec3 totalPower() const;
  std::string name(size_t light) const;  // for messages

  // The same lights, but pick() gives only those that no ray can hit: the others are left to the
  // rays of the BSDF.
  LightSet withoutHittable() const;

  // A light picked in proportion to power, for estimators that can afford one.
  size_t pick(float u, float& probability) const;
  float pickProbability(size_t light) const { return lights_[light].pickProbability; }
  // Whether a ray can meet it by chance: not if it is a point or comes from a single direction.
  bool hittable(size_t light) const {
    return lights_[light].area || std::ranges::count(hittableAtInfinity_, light) > 0;
  }

  // False: nothing can arrive at `at` (behind the emitter, outside the cone, black).
  bool sampleDirect(size_t light, Vec3 at, float u, float v, DirectSample& out) const;

  // Radiance that leaves an emissive surface towards wo; `light` is the emitter's or kNone.
  Vec3 emitted(const SurfacePoint& hit, size_t& light) const;
  // Density in 1/sr with which sampleDirect() would have chosen this hit from `from`.
  float pdfEmitted(size_t light, const SurfacePoint& hit, Vec3 from) const;

  // The point of the unit square by which sampleDirect() draws what was hit: of an emissive
  // surface, or, by the direction towards it, of a light at infinity.
  Point2 drawnBy(size_t light, const SurfacePoint& hit) const;
  Point2 drawnBy(size_t light, Vec3 direction) const;

  // How that square may be cut up.
  struct Extent {
    bool divisible = false;  // its parts can be hidden one by one
    bool local = false;      // it has a place,
    Vec3 centre;             // this one
    size_t facets = 1;       // lie side by side along u, by their power
  };
  Extent extent(size_t light) const;

  // Lights at infinity that a ray can hit: calls fn(light, radiance, pdf) for each.
  template <typename Fn>
  void forEachAtInfinity(Vec3 direction, const Fn& fn) const {
    for (const uint32_t i : hittableAtInfinity_) {
      float pdf = 0.0f;
      const Vec3 L = radianceAtInfinity(i, direction, pdf);
      if (!isBlack(L)) fn(size_t{i}, L, pdf);
    }
  }

  PhotonStart emit(size_t light, Rng& rng) const;
  // Of one such photon: its density per area of the emitter; of a light at infinity, pi times that
  // per area across the direction towards it and per solid angle (as cosine emission has 1/pi).
  // 1/unit^2; 0: no ray can hit this light. `towards` counts at infinity alone.
  float photonDensity(size_t light, Vec3 towards) const;

  // Whether any light has power. Scene::hasLight() asks the files alone: a sun along a flat scene,
  // or a lamp too weak for floats, shines there and has no power here.
  bool hasPower() const { return mean(totalPower()) > 0.0f; }
  // Throws InputError, naming the scene, when none has.
  void requirePower() const;
  // Throws InputError where floats do not hold the squares of a light's light, by which VPLs are
  // gathered.
  void requireSquares() const;

 private:
  struct Light {
    LightSpec spec;     // of scene.toml
    bool area = false;  // else a light of emissive triangles:
    uint32_t material = kNone;
    std::vector<uint32_t> triangles;
    // Over area, over the light of textured triangles, or over the texels of each row of an
    // environment image.
    std::vector<float> cdf;
    std::vector<EmissionGrid> grids;        // of textured triangles
    std::vector<double> rowCdf;             // over those rows
    std::vector<uint32_t> guide, rowGuide;  // of each row of `cdf`, and of rowCdf
    std::span<const uint32_t> guideOfRow(size_t row) const {
      return std::span(guide).subspan(row * kGuideSteps, kGuideSteps);
    }
    std::span<const float> cdfOfRow(size_t row, size_t width) const {
      return std::span(cdf).subspan(row * width, width);
    }
    float areaTotal = 0.0f;
    bool twoSided = false;
    Vec3 power;
    float pickProbability = 0.0f;
  };
  void addAreaLights();
  void addSpecLights();
  void setPickProbabilities(const std::vector<double>& weights);
  Vec3 radianceAtInfinity(size_t light, Vec3 direction, float& pdf) const;
  float texelPdf(const Light& light, size_t x, uint32_t y) const;
  Vec3 sampleDirection(const Light& light, float u, float v, Vec3& radiance, float& pdf) const;
  bool sampleArea(const Light& light, Vec3 at, float u, float v, DirectSample& out) const;
  PhotonStart emitFromInfinity(const Light& light, Rng& rng) const;
  struct EmitterPoint {
    Vec3 position, normal, emission;
    float density;  // over that of points drawn evenly from all of the light's area
  };
  EmitterPoint samplePointOn(const Light& light, float u, float v) const;
  Vec3 emissionOn(const Material& m, uint32_t triangle, const Barycentric& at) const;
  Vec3 spreadTexture(Light& light, std::vector<double>& areas) const;
  float densityOver(const Light& light, size_t i, float ofGrid) const;
  struct Hit {
    size_t triangle;  // of the light's
    Barycentric at;
  };
  Hit hitOf(const Light& light, const SurfacePoint& hit) const;
  // What all of an area light sends out if it shines like this everywhere.
  static Vec3 fluxOf(const Light& light, Vec3 emission) {
    return emission * (kPi * light.areaTotal * (light.twoSided ? 2.0f : 1.0f));
  }

  const RayScene& rays_;
  const Scene& scene_;
  std::vector<Light> lights_;
  std::vector<uint32_t> lightOfMaterial_;
  std::vector<uint32_t> hittableAtInfinity_;
  std::vector<float> pickCdf_;
};

}  // namespace bnvpl
