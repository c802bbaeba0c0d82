#include "transport/lights/lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/cdf.h"
#include "core/number_text.h"
#include "core/parallel.h"
#include "transport/lights/light_shape.h"
#include "transport/lights/textured_emission.h"

namespace bnvpl {

namespace {

// Max power of a light over the square of the scene's diagonal, W per square unit. Below it,
// squares of the irradiance at its surfaces, and sums of them, stay in the range of floats.
constexpr float kMaxEmission = 1e17f;

}  // namespace

LightSet::LightSet(const Accelerator& accel) : accel_(accel), scene_(accel.scene()) {
  addAreaLights();
  addSceneLights();
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

void LightSet::requireSquares() const {
  const float across = scene_.bounds.diagonal();
  for (size_t i = 0; i < lights_.size(); ++i) {
    const Light& l = lights_[i];
    // A spot counts as a point light of its intensity, because its power is only that in the cone.
    const bool local = !l.area && l.spec.pointOrSpot();
    const float sent = local ? maxComponent(l.spec.emission) * (4.0f * kPi) : maxComponent(l.power);
    if (!(sent / across / across > kMaxEmission)) continue;
    throw InputError(scene_.name() + ": the " + name(i) + " sends out " + shortestText(sent) +
                     " W, more than 1e17 W over the square of the scene's diagonal, " +
                     shortestText(across) + "; make it weaker, or use --integrator path or light");
  }
}

// Random numbers have 24 bits: a light of a smaller share beside a sun would never be picked, or
// too often. So each that shines has about four of them at least, and all shares are multiples of
// one.
void LightSet::setPickProbabilities(std::vector<double> weights) {
  constexpr double kSteps = 0x1p24;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double least = sum * std::min(4.0 / kSteps, 0.25 / static_cast<double>(weights.size() + 1));
  for (double& w : weights) w = w > 0.0 ? std::max(w, least) : w;
  pickCdf_ = makeCdf<float>(weights);
  for (float& upTo : pickCdf_)
    upTo = static_cast<float>(std::round(double{upTo} * kSteps) / kSteps);
  for (size_t i = 0; i < lights_.size(); ++i)
    lights_[i].pickProbability = cdfProbability<float>(pickCdf_, i);
}

LightSet LightSet::onlyUnhittable() const {
  LightSet out(*this);
  std::vector<double> weights;
  for (const Light& l : lights_) weights.push_back(l.area ? 0.0 : double{mean(l.power)});
  for (const uint32_t i : hittableAtInfinity_) weights[i] = 0.0;
  out.setPickProbabilities(weights);
  for (size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] > 0.0)) out.lights_[i].pickProbability = 0.0f;  // makeCdf() of zeros ends at 1
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
    const Material& m = scene_.materials[lights_[i].material];
    const bool even = m.emissionTexture == kNone && !m.masked();
    const Vec3 emission = even ? m.emission : spreadTexture(lights_[i], areas[i]);
    lights_[i].cdf = makeCdf<float>(areas[i]);
    lights_[i].power = fluxOf(lights_[i], emission);
  }
}

// Mean emission of a light with a texture or a mask. Makes the grids that importance-sample its
// points, and turns the areas of its triangles into weights for sampling a triangle.
Vec3 LightSet::spreadTexture(Light& light, std::vector<double>& areas) const {
  const TexturedEmission texture(scene_, light.material, light.triangles);
  light.grids.resize(areas.size());
  std::vector<std::array<double, 3>> sums(areas.size());
  parallelFor(areas.size(), 16, [&](size_t i) {
    const uint32_t triangle = light.triangles[i], side = texture.side(triangle);
    std::vector<TexturedEmission::Mean> cells(size_t{side} * side);
    parallelFor(side, 16, [&](size_t row) {
      const auto r = static_cast<uint32_t>(row);
      for (uint32_t c = 0; c < 2 * r + 1; ++c)
        cells[row * row + c] = texture.over(triangle, EmissionGrid::corners(side, r, c));
    });
    std::vector<double> weights;
    double weight = 0.0;
    for (const TexturedEmission::Mean& cell : cells) {
      weights.push_back(cell.weight);
      weight += cell.weight;
      for (size_t c = 0; c < 3; ++c) sums[i][c] += cell.emission[c];
    }
    light.grids[i] = EmissionGrid(side, weights);
    for (double& s : sums[i]) s *= areas[i] / static_cast<double>(cells.size());
    areas[i] *= weight / static_cast<double>(cells.size());
  });
  std::array<double, 3> sum{};
  for (const auto& s : sums)
    for (size_t c = 0; c < 3; ++c) sum[c] += s[c] / double{light.areaTotal};
  return {float(sum[0]), float(sum[1]), float(sum[2])};
}

namespace {

// Power of the photons of an environment image, W. A sum of floats over millions of texels would
// lose precision.
std::array<double, 3> powerOf(const LightSpec& s, const EnvironmentImage& image,
                              const Bounds& bounds) {
  std::vector<std::array<double, 3>> rows(image.height);
  parallelFor(image.height, 16, [&](size_t row) {
    const auto y = static_cast<uint32_t>(row);
    const float solidAngle = texelSolidAngle(image, y);
    for (uint32_t x = 0; x < image.width; ++x) {
      const Vec3 radiance = image.radiance[size_t{y} * image.width + x];
      const Vec3 d = directionOf(s, (float(x) + 0.5f) / float(image.width),
                                 (float(y) + 0.5f) / float(image.height));
      const float part = s.scale * solidAngle * silhouetteArea(bounds, d);
      for (size_t c = 0; c < 3; ++c) rows[row][c] += double{radiance[c] * part};
    }
  });
  std::array<double, 3> power{};
  for (const auto& row : rows)
    for (size_t c = 0; c < 3; ++c) power[c] += row[c];
  return power;
}

}  // namespace

void LightSet::addSceneLights() {
  for (const LightSpec& s : scene_.lights) {
    Light l;
    l.spec = s;
    switch (s.type) {
      case LightType::Point:
        l.power = s.emission * (4.0f * kPi);
        break;
      case LightType::Spot:
        l.power = s.emission * spotSolidAngle(s);
        break;
      case LightType::Directional:
        l.power = s.emission * silhouetteArea(scene_.bounds, s.direction);
        break;
      case LightType::Environment: {
        if (s.image == kNone) {
          const Vec3 e =
              scene_.bounds.extent();  // a box's mean projected area is a quarter of its surface
          l.power =
              s.emission * (s.scale * 4.0f * kPi * 0.5f * (e.x * e.y + e.y * e.z + e.z * e.x));
          break;
        }
        const EnvironmentImage& image = scene_.environments[s.image];
        std::vector<double> rows(image.height), row(image.width);
        const std::array<double, 3> power = powerOf(s, image, scene_.bounds);
        l.cdf.reserve(image.radiance.size());
        for (uint32_t y = 0; y < image.height; ++y) {
          const float solidAngle = texelSolidAngle(image, y);
          for (uint32_t x = 0; x < image.width; ++x) {
            const Vec3 radiance = image.radiance[size_t{y} * image.width + x];
            row[x] = double{mean(radiance)};
            rows[y] += row[x] * double{solidAngle};
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
  throw InputError(scene_.noLight());
}

std::string LightSet::name(size_t light) const {
  const Light& l = lights_[light];
  if (l.area) return "emissive material '" + scene_.materials[l.material].name + "'";
  const char* const names[] = {"point light", "spot light", "directional light", "environment"};
  const std::string kind = names[static_cast<size_t>(l.spec.type)];
  return l.spec.name.empty() ? kind : kind + " '" + l.spec.name + "'";
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

float LightSet::pdfDirect(size_t light, const SurfacePoint& hit, Vec3 from) const {
  const Light& l = lights_[light];
  const float cosine = dot(hit.ng, hit.wo);
  if (!(cosine > 0.0f)) return 0.0f;
  const float even = lengthSquared(hit.position - from) / (cosine * l.areaTotal);
  if (l.grids.empty()) return even;
  const Hit at = hitOf(l, hit);
  return even * densityOver(l, at.triangle, l.grids[at.triangle].density(at.at));
}

// Density of a point relative to uniform sampling of the light's area. `ofGrid` is the same within
// the triangle.
float LightSet::densityOver(const Light& light, size_t i, float ofGrid) const {
  const uint32_t t = light.triangles[i];
  const float area = 0.5f * length(cross(scene_.corner(t, 1) - scene_.corner(t, 0),
                                         scene_.corner(t, 2) - scene_.corner(t, 0)));
  return cdfProbability<float>(light.cdf, i) * light.areaTotal / area * ofGrid;
}

}  // namespace bnvpl
