#include "transport/lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cdf.h"
#include "transport/light_shape.h"

namespace bnvpl {

LightSet::LightSet(const RayScene& rays) : rays_(rays), scene_(rays.scene()) {
  addAreaLights();
  addSpecLights();
  std::vector<double> weights;
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (!std::isfinite(mean(lights_[i].power))) {
      throw InputError(scene_.name() + ": the power of the " + name(i) +
                       " is beyond the range of floats; make it weaker or smaller");
    }
    weights.push_back(mean(lights_[i].power));
  }
  setPickProbabilities(weights);
}

void LightSet::setPickProbabilities(const std::vector<double>& weights) {
  pickCdf_ = makeCdf<float>(weights);
  for (size_t i = 0; i < lights_.size(); ++i)
    lights_[i].pickProbability = cdfShare<float>(pickCdf_, i);
}

LightSet LightSet::withoutHittable() const {
  LightSet out(*this);
  std::vector<double> weights;
  for (const Light& l : lights_) weights.push_back(l.area ? 0.0 : double{mean(l.power)});
  for (const uint32_t i : hittableAtInfinity_) weights[i] = 0.0;
  out.setPickProbabilities(weights);
  for (size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] > 0.0)) out.lights_[i].pickProbability = 0.0f;  // where none is left
  return out;
}

void LightSet::addAreaLights() {
  lightOfMaterial_.assign(scene_.materials.size(), kNone);
  std::vector<std::vector<double>> areas;
  for (uint32_t t = 0; t < scene_.triangles.size(); ++t) {
    const uint32_t m = scene_.triangles[t].material;
    if (isBlack(scene_.materials[m].emission)) continue;
    if (lightOfMaterial_[m] == kNone) {
      lightOfMaterial_[m] = static_cast<uint32_t>(lights_.size());
      Light l;
      l.area = true;
      l.material = m;
      l.twoSided = scene_.materials[m].twoSidedEmission;
      lights_.push_back(l);
      areas.emplace_back();
    }
    const uint32_t i = lightOfMaterial_[m];
    lights_[i].triangles.push_back(t);
    areas[i].push_back(0.5 * double{length(cross(scene_.corner(t, 1) - scene_.corner(t, 0),
                                                 scene_.corner(t, 2) - scene_.corner(t, 0)))});
  }
  for (size_t i = 0; i < lights_.size(); ++i) {
    double total = 0.0;
    for (const double a : areas[i]) total += a;
    lights_[i].areaTotal = static_cast<float>(total);
    lights_[i].cdf = makeCdf<float>(areas[i]);
    lights_[i].power = fluxOf(lights_[i], meanEmission(lights_[i], areas[i]));
  }
}

// Over the surface. Of a texture, by some points of each triangle: it only shares out rays and
// photons.
Vec3 LightSet::meanEmission(const Light& light, const std::vector<double>& areas) const {
  const Material& m = scene_.materials[light.material];
  if (m.emissionTexture == kNone) return m.emission;
  const size_t points = std::clamp<size_t>(4096 / areas.size(), 1, 1024);
  std::array<double, 3> sum{};
  double total = 0.0;
  for (size_t i = 0; i < areas.size(); ++i) {
    for (size_t k = 0; k < points; ++k) {
      const Point2 at = r2Sequence(k, 0.5, 0.5);
      const Vec3 emission = emissionOn(m, light.triangles[i], sampleTriangle(at.x, at.y));
      for (size_t c = 0; c < 3; ++c) sum[c] += double{emission[c]} * areas[i];
    }
    total += areas[i] * static_cast<double>(points);
  }
  return {float(sum[0] / total), float(sum[1] / total), float(sum[2] / total)};
}

void LightSet::addSpecLights() {
  for (const LightSpec& s : scene_.lights) {
    Light l;
    l.spec = s;
    switch (s.type) {
      case LightType::Point:
        l.power = s.emission * (4.0f * kPi);
        break;
      case LightType::Spot: {
        // Integral of the falloff over the cone, by the midpoint rule: it only shares out photons.
        double integral = 0.0;
        constexpr int kSteps = 256;
        for (int i = 0; i < kSteps; ++i) {
          const double angle = (i + 0.5) / kSteps * double{s.coneRad};
          integral += double{spotFalloff(s, float(std::cos(angle)))} * std::sin(angle) *
                      double{s.coneRad} / kSteps;
        }
        l.power = s.emission * (2.0f * kPi * static_cast<float>(integral));
        break;
      }
      case LightType::Directional:
        l.power = s.emission * silhouetteArea(scene_.bounds, s.direction);
        break;
      case LightType::Environment: {
        if (s.image == kNone) {
          const Vec3 e =
              scene_.bounds.extent();  // mean silhouette of a box: a quarter of its surface
          l.power =
              s.emission * (s.scale * 4.0f * kPi * 0.5f * (e.x * e.y + e.y * e.z + e.z * e.x));
          break;
        }
        const EnvironmentImage& image = scene_.environments[s.image];
        std::vector<double> rows(image.height), row(image.width);
        std::array<double, 3> power{};  // a float loses count of millions of texels
        l.cdf.reserve(image.radiance.size());
        for (uint32_t y = 0; y < image.height; ++y) {
          const float solidAngle = texelSolidAngle(image, y);
          for (uint32_t x = 0; x < image.width; ++x) {
            const Vec3 radiance = image.radiance[size_t{y} * image.width + x];
            row[x] = double{mean(radiance)};
            rows[y] += row[x] * double{solidAngle};
            const Vec3 d = directionOf(s, (float(x) + 0.5f) / float(image.width),
                                       (float(y) + 0.5f) / float(image.height));
            const float part = s.scale * solidAngle * silhouetteArea(scene_.bounds, d);
            for (size_t c = 0; c < 3; ++c) power[c] += double{radiance[c] * part};
          }
          const std::vector<float> cdf = makeCdf<float>(row);
          l.cdf.insert(l.cdf.end(), cdf.begin(), cdf.end());
          appendGuide<float>(cdf, l.guide);
        }
        l.rowCdf = makeCdf<double>(rows);
        appendGuide<double>(l.rowCdf, l.rowGuide);
        for (size_t c = 0; c < 3; ++c) l.power[c] = static_cast<float>(power[c]);
        break;
      }
    }
    if (s.type == LightType::Environment ||
        (s.type == LightType::Directional && s.angularRadiusRad > 0.0f)) {
      hittableAtInfinity_.push_back(static_cast<uint32_t>(lights_.size()));
    }
    lights_.push_back(std::move(l));
  }
}

Vec3 LightSet::totalPower() const {
  Vec3 sum;
  for (const Light& l : lights_) sum += l.power;
  return sum;
}

void LightSet::requirePower() const {
  if (hasPower()) return;
  throw InputError(scene_.name() + ": " + kNoLight);
}

std::string LightSet::name(size_t light) const {
  const Light& l = lights_[light];
  if (l.area) return "emissive material '" + scene_.materials[l.material].name + "'";
  const char* const names[] = {"point light", "spot light", "directional light", "environment"};
  return names[static_cast<size_t>(l.spec.type)];
}

size_t LightSet::pick(float u, float& probability) const {
  const size_t i = sampleCdf<float>(pickCdf_, u);
  probability = lights_[i].pickProbability;
  return i;
}

Vec3 LightSet::emitted(const SurfacePoint& hit, size_t& light) const {
  light = lightOfMaterial_[hit.material];
  if (light == kNone || !(hit.front || lights_[light].twoSided)) return {};
  return scene_.emissionAt(scene_.materials[hit.material], hit.u, hit.v);
}

float LightSet::pdfEmitted(size_t light, const SurfacePoint& hit, Vec3 from) const {
  const float cosine = dot(hit.ng, hit.wo);
  return cosine > 0.0f ? lengthSquared(hit.position - from) / (cosine * lights_[light].areaTotal)
                       : 0.0f;
}

}  // namespace bnvpl
