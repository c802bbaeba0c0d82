#include "scene/lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/sampling.h"

namespace bnvpl {

namespace {

// Area of the scene's box seen along a unit direction: what a distant light's photons must cover.
float silhouetteArea(const Bounds& box, Vec3 direction) {
  const Vec3 e = box.extent();
  return std::fabs(direction.x) * e.y * e.z + std::fabs(direction.y) * e.x * e.z +
         std::fabs(direction.z) * e.x * e.y;
}

// Index by a running sum that ends at 1, and the share of u inside that entry, to be used again.
template <typename T>
size_t sampleCdf(std::span<const T> cdf, float& u) {
  const auto it = std::upper_bound(cdf.begin(), cdf.end() - 1, static_cast<T>(u));
  const auto i = static_cast<size_t>(it - cdf.begin());
  const T low = i > 0 ? cdf[i - 1] : T{0}, width = cdf[i] - low;
  u = width > T{0} ? std::min(static_cast<float>((static_cast<T>(u) - low) / width), 0x1.fffffep-1f)
                   : 0.0f;
  return i;
}

template <typename T>
std::vector<T> makeCdf(const std::vector<double>& weights) {
  std::vector<T> cdf(weights.size());
  double sum = 0.0, running = 0.0;
  for (const double w : weights) sum += w;
  for (size_t i = 0; i < weights.size(); ++i) {
    running += weights[i];
    cdf[i] = sum > 0.0 ? static_cast<T>(running / sum) : T{0};
  }
  if (!cdf.empty()) cdf.back() = T{1};
  return cdf;
}

template <typename T>
T cdfShare(std::span<const T> cdf, size_t i) {
  return cdf[i] - (i > 0 ? cdf[i - 1] : T{0});
}

float spotFalloff(const LightSpec& s, float cosAngle) {
  const float angle = std::acos(std::clamp(cosAngle, -1.0f, 1.0f));
  if (angle >= s.coneRad) return 0.0f;
  const float inner = s.coneRad - s.falloffRad;
  if (angle <= inner) return 1.0f;
  const float t = (s.coneRad - angle) / s.falloffRad;
  return t * t * (3.0f - 2.0f * t);
}

// Directions of an environment image: u turns about +y from -z over +x, v goes down from +y. The
// image is turned as rotate_deg turns a mesh: by the right-hand rule.
Vec3 directionOf(const LightSpec& s, float u, float v) {
  const float phi = 2.0f * kPi * (u - 0.5f) - s.rotateRad, theta = kPi * v;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}
void texelOf(const LightSpec& s, Vec3 d, float& u, float& v) {
  const float turns = (std::atan2(d.x, -d.z) + s.rotateRad) / (2.0f * kPi) + 0.5f;
  u = std::min(turns - std::floor(turns), 0x1.fffffep-1f);
  v = std::min(std::acos(std::clamp(d.y, -1.0f, 1.0f)) / kPi, 0x1.fffffep-1f);
}

// Difference of the cosines of the polar angles that bound a row of texels: as a product, for near
// the poles of a fine image both round to 1.
float bandHeight(uint32_t row, uint32_t rows) {
  const double half = 0.5 * double{kPi} / static_cast<double>(rows);
  return static_cast<float>(2.0 * std::sin((2.0 * row + 1.0) * half) * std::sin(half));
}

float texelSolidAngle(const EnvironmentImage& image, uint32_t row) {
  return 2.0f * kPi / float(image.width) * bandHeight(row, image.height);
}

// A cone by 1 - cos of its half angle, which keeps its digits where the cosine rounds to 1: at the
// sun's 0.27 degrees the cosine of a float has 8 bits left, below 0.014 none.
float versine(float angleRad) {
  const float s = std::sin(0.5f * angleRad);
  return 2.0f * s * s;
}
Vec3 sampleNarrowCone(float u, float v, float coneVersine) {
  const float w = u * coneVersine, r = std::sqrt(w * (2.0f - w));
  return {r * std::cos(2.0f * kPi * v), r * std::sin(2.0f * kPi * v), 1.0f - w};
}
float pdfNarrowCone(float coneVersine) { return 1.0f / (2.0f * kPi * coneVersine); }
bool inNarrowCone(Vec3 direction, Vec3 axis, float coneVersine) {  // |a - b|^2 = 2 (1 - cos)
  return lengthSquared(direction - axis) <= 2.0f * coneVersine;
}

Vec3 sunRadiance(const LightSpec& s) {  // irradiance = radiance * pi sin^2(angular radius)
  const float sine = std::sin(s.angularRadiusRad);
  return s.emission * (1.0f / (kPi * sine * sine));
}

}  // namespace

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
  pickCdf_ = makeCdf<float>(weights);
  for (size_t i = 0; i < lights_.size(); ++i)
    lights_[i].pickProbability = cdfShare<float>(pickCdf_, i);
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
    lights_[i].power = scene_.materials[lights_[i].material].emission *
                       (kPi * lights_[i].areaTotal * (lights_[i].twoSided ? 2.0f : 1.0f));
  }
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
        }
        l.rowCdf = makeCdf<double>(rows);
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
  if (mean(totalPower()) > 0.0f) return;
  throw InputError(scene_.name() +
                   ": has no light with power; add a [[light]] or an emissive material (Ke)");
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

Vec3 LightSet::samplePointOn(const Light& light, float u, float v, Vec3& normal) const {
  const uint32_t t = light.triangles[sampleCdf<float>(light.cdf, u)];
  const Vec3 p0 = scene_.corner(t, 0), p1 = scene_.corner(t, 1), p2 = scene_.corner(t, 2);
  const Barycentric b = sampleTriangle(u, v);
  normal = normalize(cross(p1 - p0, p2 - p0));
  return (1.0f - b.u - b.v) * p0 + b.u * p1 + b.v * p2;
}

bool LightSet::sampleArea(const Light& light, Vec3 at, float u, float v, DirectSample& out) const {
  Vec3 n;
  const Vec3 p = samplePointOn(light, u, v, n);
  const Vec3 d = p - at;
  const float d2 = lengthSquared(d);
  if (!(d2 > 0.0f)) return false;
  out.wi = d / std::sqrt(d2);
  float cosine = -dot(n, out.wi);
  if (light.twoSided && cosine < 0.0f) {
    cosine = -cosine;
    n = -n;
  }
  if (cosine <= 0.0f) return false;
  out.pdf = d2 / (cosine * light.areaTotal);
  out.radianceOverPdf = scene_.materials[light.material].emission * (1.0f / out.pdf);
  out.infinite = false;
  out.target = rays_.lifted(p, n);
  return true;
}

// Of the directions in a texel, in 1/sr. By row, then by column: over all texels at once, the
// shares of a fine image would be below the steps of a float.
float LightSet::texelPdf(const Light& light, size_t x, uint32_t y) const {
  const EnvironmentImage& image = scene_.environments[light.spec.image];
  return static_cast<float>(cdfShare<double>(light.rowCdf, y)) *
         cdfShare(light.cdfOfRow(y, image.width), x) / texelSolidAngle(image, y);
}

// A direction towards a light at infinity.
Vec3 LightSet::sampleDirection(const Light& light, float u, float v, Vec3& radiance,
                               float& pdf) const {
  const LightSpec& s = light.spec;
  if (s.type == LightType::Directional) {
    if (s.angularRadiusRad == 0.0f) {
      pdf = 0.0f;
      radiance = s.emission;
      return -s.direction;
    }
    pdf = pdfNarrowCone(versine(s.angularRadiusRad));
    radiance = sunRadiance(s);
    return Basis(-s.direction).toWorld(sampleNarrowCone(u, v, versine(s.angularRadiusRad)));
  }
  if (s.image == kNone) {
    pdf = 1.0f / (4.0f * kPi);
    radiance = s.emission * s.scale;
    return sampleSphere(u, v);
  }
  const EnvironmentImage& image = scene_.environments[s.image];
  const auto y = static_cast<uint32_t>(sampleCdf<double>(light.rowCdf, v));
  const size_t x = sampleCdf(light.cdfOfRow(y, image.width), u);
  // Uniform in solid angle inside the texel: linear in longitude and in the cosine of the polar
  // angle.
  const float top = std::cos(kPi * float(y) / float(image.height));
  const float row = std::acos(std::clamp(top - v * bandHeight(y, image.height), -1.0f, 1.0f)) / kPi;
  pdf = texelPdf(light, x, y);
  radiance = image.radiance[size_t{y} * image.width + x] * s.scale;
  return directionOf(s, (float(x) + u) / float(image.width), row);
}

Vec3 LightSet::radianceAtInfinity(size_t index, Vec3 direction, float& pdf) const {
  const Light& light = lights_[index];
  const LightSpec& s = light.spec;
  if (s.type == LightType::Directional) {
    if (!inNarrowCone(direction, -s.direction, versine(s.angularRadiusRad))) return {};
    pdf = pdfNarrowCone(versine(s.angularRadiusRad));
    return sunRadiance(s);
  }
  if (s.image == kNone) {
    pdf = 1.0f / (4.0f * kPi);
    return s.emission * s.scale;
  }
  const EnvironmentImage& image = scene_.environments[s.image];
  float u, v;
  texelOf(s, direction, u, v);
  const auto x = static_cast<size_t>(u * float(image.width));
  const auto y = static_cast<uint32_t>(v * float(image.height));
  pdf = texelPdf(light, x, y);
  return image.lookup(u, v) * s.scale;
}

bool LightSet::sampleDirect(size_t index, Vec3 at, float u, float v, DirectSample& out) const {
  const Light& light = lights_[index];
  if (light.area) return sampleArea(light, at, u, v, out);
  const LightSpec& s = light.spec;
  if (s.type == LightType::Point || s.type == LightType::Spot) {
    const Vec3 d = s.position - at;
    const float d2 = lengthSquared(d);
    if (!(d2 > 0.0f)) return false;
    out.wi = d / std::sqrt(d2);
    const float falloff =
        s.type == LightType::Spot ? spotFalloff(s, -dot(out.wi, s.direction)) : 1.0f;
    out.radianceOverPdf = s.emission * (falloff / d2);
    out.pdf = 0.0f;
    out.infinite = false;
    out.target = s.position;
    return !isBlack(out.radianceOverPdf);
  }
  Vec3 radiance;
  out.wi = sampleDirection(light, u, v, radiance, out.pdf);
  out.radianceOverPdf = out.pdf > 0.0f ? radiance * (1.0f / out.pdf) : radiance;
  out.infinite = true;
  return !isBlack(out.radianceOverPdf);
}

Vec3 LightSet::emitted(const SurfacePoint& hit, size_t& light) const {
  light = lightOfMaterial_[hit.material];
  if (light == kNone || !(hit.front || lights_[light].twoSided)) return {};
  return scene_.materials[hit.material].emission;
}

float LightSet::pdfEmitted(size_t light, const SurfacePoint& hit, Vec3 from) const {
  const float cosine = dot(hit.ng, hit.wo);
  return cosine > 0.0f ? lengthSquared(hit.position - from) / (cosine * lights_[light].areaTotal)
                       : 0.0f;
}

// Photons from infinity start on the faces of the scene's box that look towards the light,
// uniformly in projected area: no photon is spent on empty space beside a long scene.
PhotonStart LightSet::emitFromInfinity(const Light& light, Rng& rng) const {
  const float u = rng.next(), v = rng.next();
  Vec3 radiance;
  float pdf = 0.0f;
  const Vec3 towards = sampleDirection(light, u, v, radiance, pdf);
  const Vec3 d = -towards, e = scene_.bounds.extent();
  const float face[3] = {std::fabs(d.x) * e.y * e.z, std::fabs(d.y) * e.x * e.z,
                         std::fabs(d.z) * e.x * e.y};
  const float total = face[0] + face[1] + face[2];
  const float pick = rng.next() * total;
  const size_t axis = pick < face[0] ? 0 : pick < face[0] + face[1] ? 1 : 2;
  Vec3 p = scene_.bounds.lower + e * Vec3{rng.next(), rng.next(), rng.next()};
  p[axis] = d[axis] > 0.0f ? scene_.bounds.lower[axis] : scene_.bounds.upper[axis];
  PhotonStart start;
  start.direction = d;
  // Back along the ray by a little of the scene's size, so that a surface in the face itself is
  // met.
  start.origin = p - d * (0x1p-10f * scene_.bounds.diagonal());
  start.flux = radiance * (pdf > 0.0f ? total / pdf : total);
  return start;
}

PhotonStart LightSet::emit(size_t index, Rng& rng) const {
  const Light& light = lights_[index];
  const LightSpec& s = light.spec;
  PhotonStart start;
  if (light.area) {
    Vec3 n;
    const float u = rng.next(), v = rng.next();
    const Vec3 p = samplePointOn(light, u, v, n);
    if (light.twoSided && rng.next() < 0.5f) n = -n;
    const float a = rng.next(), b = rng.next();
    start.direction = Basis(n).toWorld(sampleCosineHemisphere(a, b));
    start.origin = rays_.lifted(p, n);
    start.flux = light.power;
  } else if (s.type == LightType::Point) {
    const float u = rng.next(), v = rng.next();
    start = {s.position, sampleSphere(u, v), light.power};
  } else if (s.type == LightType::Spot) {
    const float u = rng.next(), v = rng.next();
    const Vec3 d = sampleNarrowCone(u, v, versine(s.coneRad));
    start.origin = s.position;
    start.direction = Basis(s.direction).toWorld(d);
    start.flux = s.emission * (spotFalloff(s, d.z) / pdfNarrowCone(versine(s.coneRad)));
  } else {
    start = emitFromInfinity(light, rng);
  }
  return start;
}

}  // namespace bnvpl
