// The part of LightSet that samples directions towards lights and emits photons.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/cdf.h"
#include "core/prefetch.h"
#include "transport/accelerator/alpha_mask.h"
#include "transport/lights/light_shape.h"
#include "transport/lights/lights.h"

namespace bnvpl {

LightSet::EmitterPoint LightSet::samplePointOn(const Light& light, float u, float v) const {
  const size_t i = sampleCdf<float>(light.cdf, u);
  const uint32_t t = light.triangles[i];
  const Vec3 p0 = scene_.corner(t, 0), p1 = scene_.corner(t, 1), p2 = scene_.corner(t, 2);
  Barycentric b;
  float density = 1.0f;
  if (light.grids.empty()) {
    b = sampleTriangle(u, v);
  } else {
    const EmissionGrid::Drawn drawn = light.grids[i].sample(u, v);
    b = drawn.at;
    density = densityOver(light, i, drawn.density);
  }
  const Material& m = scene_.materials[light.material];
  const bool there = density > 0.0f && (!m.masked() || passesAlphaTest(scene_, t, b.u, b.v));
  return {(1.0f - b.u - b.v) * p0 + b.u * p1 + b.v * p2, normalize(cross(p1 - p0, p2 - p0)),
          there ? emissionOn(m, t, b) : Vec3(), there ? density : 1.0f};
}

Vec3 LightSet::emissionOn(const Material& m, uint32_t triangle, const Barycentric& b) const {
  if (m.emissionTexture == kNone) return m.emission;
  const Triangle& t = scene_.triangles[triangle];
  if (t.uv[0] == kNone || t.uv[1] == kNone || t.uv[2] == kNone) return m.emission;
  const auto &p = scene_.uvs[t.uv[0]], &q = scene_.uvs[t.uv[1]], &r = scene_.uvs[t.uv[2]];
  const float first = 1.0f - b.u - b.v;
  return scene_.emissionAt(m, first * p[0] + b.u * q[0] + b.v * r[0],
                           first * p[1] + b.u * q[1] + b.v * r[1]);
}

bool LightSet::sampleArea(const Light& light, Vec3 at, float u, float v, LightSample& out) const {
  const auto [p, normal, emission, density] = samplePointOn(light, u, v);
  Vec3 n = normal;
  const Vec3 d = p - at;
  const float d2 = lengthSquared(d);
  if (!(d2 > 0.0f)) return false;
  out.wi = d / std::sqrt(d2);
  float cosine = -dot(n, out.wi);
  if (light.twoSided && cosine < 0.0f) {
    cosine = -cosine;
    n = -n;
  }
  if (cosine <= 0.0f || isBlack(emission)) return false;
  out.pdf = d2 / (cosine * light.areaTotal) * density;
  out.radianceOverPdf = emission * (1.0f / out.pdf);
  out.infinite = false;
  out.target = accel_.offsetOrigin(p, n);
  return true;
}

// Density of directions in a texel, 1/sr. Rows and columns have running sums of their own, because
// the shares of single texels of a fine image would be below a float's precision.
float LightSet::texelPdf(const Light& light, size_t x, uint32_t y) const {
  const EnvironmentImage& image = scene_.environments[light.spec.image];
  return static_cast<float>(cdfProbability<double>(light.rowCdf, y)) *
         cdfProbability(light.cdfOfRow(y, image.width), x) / texelSolidAngle(image, y);
}

// Samples a direction towards a light at infinity.
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
    return Frame(-s.direction).toWorld(sampleNarrowCone(u, v, versine(s.angularRadiusRad)));
  }
  if (s.image == kNone) {
    pdf = 1.0f / (4.0f * kPi);
    radiance = s.emission * s.scale;
    return sampleSphere(u, v);
  }
  const EnvironmentImage& image = scene_.environments[s.image];
  const auto y = static_cast<uint32_t>(sampleCdf<double>(light.rowCdf, light.rowGuide, v));
  const size_t x = sampleCdf(light.cdfOfRow(y, image.width), light.guideOfRow(y), u);
  const Vec3& texel = image.radiance[size_t{y} * image.width + x];
  prefetch(&texel);  // overlaps with the computation of the direction
  // Inside the texel directions are uniform in solid angle: linear in longitude and in the cosine
  // of the polar angle.
  const Vec3 direction =
      directionOf(s, (float(x) + u) / float(image.width), sampleRow(y, image.height, v));
  pdf = texelPdf(light, x, y);
  radiance = texel * s.scale;
  return direction;
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

bool LightSet::sampleDirect(size_t index, Vec3 at, float u, float v, LightSample& out) const {
  const Light& light = lights_[index];
  if (light.area) return sampleArea(light, at, u, v, out);
  const LightSpec& s = light.spec;
  if (s.pointOrSpot()) {
    const Vec3 d = s.position - at;
    const float d2 = lengthSquared(d);
    if (!(d2 > 0.0f)) return false;
    out.wi = d / std::sqrt(d2);
    const float falloff =
        s.type == LightType::Spot ? spotFalloff(s, versineBetween(-out.wi, s.direction)) : 1.0f;
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

LightSet::Hit LightSet::hitOf(const Light& light, const SurfacePoint& hit) const {
  const auto it = std::lower_bound(light.triangles.begin(), light.triangles.end(), hit.triangle);
  const Vec3 p0 = scene_.corner(hit.triangle, 0), e1 = scene_.corner(hit.triangle, 1) - p0,
             e2 = scene_.corner(hit.triangle, 2) - p0, d = hit.position - p0;
  const Vec3 n = cross(e1, e2);
  const float perArea = 1.0f / lengthSquared(n);
  return {static_cast<size_t>(it - light.triangles.begin()),
          {std::max(0.0f, dot(cross(d, e2), n) * perArea),
           std::max(0.0f, dot(cross(e1, d), n) * perArea)}};
}

Point2 LightSet::invertSample(size_t index, const SurfacePoint& hit) const {
  const Light& light = lights_[index];
  const auto [i, at] = hitOf(light, hit);
  const Point2 within =
      light.grids.empty() ? invertTriangleSample(at) : light.grids[i].invertSample(at);
  const float begin = i > 0 ? light.cdf[i - 1] : 0.0f;
  return {begin + within.x * cdfProbability<float>(light.cdf, i), within.y};
}

Point2 LightSet::invertSample(size_t index, Vec3 direction) const {
  const Light& light = lights_[index];
  const LightSpec& s = light.spec;
  if (s.type == LightType::Directional) return {0.5f, 0.5f};  // the light is one stratum
  if (s.image == kNone) return invertSphereSample(direction);
  const EnvironmentImage& image = scene_.environments[s.image];
  float u, v;
  texelOf(s, direction, u, v);
  u *= float(image.width);
  const auto x = static_cast<size_t>(u);
  const auto y = static_cast<uint32_t>(v * float(image.height));
  const float down = invertRow(y, image.height, v);
  const std::span<const float> row = light.cdfOfRow(y, image.width);
  const double above = y > 0 ? light.rowCdf[y - 1] : 0.0;
  return {(x > 0 ? row[x - 1] : 0.0f) + (u - float(x)) * cdfProbability(row, x),
          static_cast<float>(above + double{down} * cdfProbability<double>(light.rowCdf, y))};
}

LightSet::Extent LightSet::extent(size_t index) const {
  const Light& light = lights_[index];
  if (light.area) {
    Bounds bounds;
    for (const uint32_t t : light.triangles)
      for (size_t c = 0; c < 3; ++c) bounds.extend(scene_.corner(t, c));
    return {true, true, bounds.center(), light.triangles.size()};
  }
  return {light.spec.type == LightType::Environment, light.spec.pointOrSpot(), light.spec.position,
          1};
}

// Photons from infinity start on the faces of the scene's box that face the light, uniformly in
// projected area, so that none is wasted on empty space beside an elongated scene.
PhotonStart LightSet::emitFromInfinity(const Light& light, const PrimarySample& at) const {
  Vec3 radiance;
  float pdf = 0.0f;
  const Vec3 towards = sampleDirection(light, at[0], at[1], radiance, pdf);
  const Vec3 d = -towards, e = scene_.bounds.extent();
  const Vec3 face = projectedFaces(scene_.bounds, d);
  const float total = face.x + face.y + face.z;
  float along = at[2] * total;  // the faces lie side by side
  size_t axis = 0;
  while (axis < 2 && along >= face[axis]) along -= face[axis++];
  const size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
  Vec3 p;
  p[axis] = d[axis] > 0.0f ? scene_.bounds.lower[axis] : scene_.bounds.upper[axis];
  const float share = face[axis] > 0.0f ? std::min(along / face[axis], 1.0f) : 0.0f;
  p[across] = scene_.bounds.lower[across] + e[across] * share;
  p[up] = scene_.bounds.lower[up] + e[up] * at[3];
  PhotonStart start;
  start.direction = d;
  // The origin is moved back along the ray, so that a surface in the face itself is hit.
  start.origin = p - d * (0x1p-10f * scene_.bounds.diagonal());
  start.flux = radiance * (pdf > 0.0f ? total / pdf : total);
  return start;
}

bool LightSet::photonsReach(size_t index, Vec3 towards, Vec3 from) const {
  const Light& light = lights_[index];
  if (light.area || light.spec.pointOrSpot()) return true;
  // Rounding puts points of the outermost faces beside the box. Photons start farther out.
  const Vec3 rounding(0x1p-11f * scene_.bounds.diagonal());
  const Bounds around{scene_.bounds.lower - rounding, scene_.bounds.upper + rounding};
  return around.isHitBy(from, towards);
}

PrimarySample LightSet::invertEmission(size_t index, Point2 place, Vec3 towards, Vec3 from) const {
  const Light& light = lights_[index];
  PrimarySample at{place.x, place.y, 0.0f, 0.0f};
  if (light.area) {
    const Vec3 n = samplePointOn(light, place.x, place.y).normal;
    const bool back = light.twoSided && dot(n, towards) > 0.0f;
    const Point2 direction = invertCosineHemisphereSample(Frame(back ? -n : n).toLocal(-towards));
    at[2] = light.twoSided ? 0.5f * direction.x + (back ? 0.0f : 0.5f) : direction.x;
    at[3] = direction.y;
    return at;
  }
  if (light.spec.type == LightType::Point) {
    const Point2 direction = invertSphereSample(-towards);
    return {direction.x, direction.y, 0.0f, 0.0f};
  }
  if (light.spec.type == LightType::Spot) {
    const Vec3 d = Frame(light.spec.direction).toLocal(-towards);
    const Point2 direction = invertNarrowConeSample(d, versine(light.spec.coneRad));
    return {direction.x, direction.y, 0.0f, 0.0f};
  }
  // The face of the box by which the ray enters it.
  const Vec3 e = scene_.bounds.extent(), face = projectedFaces(scene_.bounds, towards);
  size_t axis = 0;
  float least = INFINITY;
  for (size_t k = 0; k < 3; ++k) {
    if (!(face[k] > 0.0f)) continue;
    const float end = towards[k] > 0.0f ? scene_.bounds.upper[k] : scene_.bounds.lower[k];
    const float distance = (end - from[k]) / towards[k];
    if (distance < least) least = distance, axis = k;
  }
  const auto share = [&](size_t k) {
    const float x = from[k] + least * towards[k] - scene_.bounds.lower[k];
    return e[k] > 0.0f ? std::clamp(x / e[k], 0.0f, 1.0f) : 0.0f;
  };
  float before = 0.0f;
  for (size_t k = 0; k < axis; ++k) before += face[k];
  at[2] = (before + share((axis + 1) % 3) * face[axis]) / (face.x + face.y + face.z);
  at[3] = share((axis + 2) % 3);
  return at;
}

std::span<const uint8_t> LightSet::primaryDimensions(size_t index) const {
  static constexpr std::array<uint8_t, 4> kAll{0, 1, 2, 3};
  const Light& light = lights_[index];
  if (light.area || light.spec.type == LightType::Environment) return kAll;
  // A sun's directions are too narrow to matter.
  return light.spec.type == LightType::Directional ? std::span(kAll).last(2)
                                                   : std::span(kAll).first(2);
}

float LightSet::photonDensity(size_t index, Vec3 towards) const {
  const Light& light = lights_[index];
  if (light.area) return 1.0f / (light.areaTotal * (light.twoSided ? 2.0f : 1.0f));
  if (!hittable(index)) return 0.0f;
  float pdf = 0.0f;
  if (light.spec.type == LightType::Directional)  // directions at its rim may round out of the sun
    pdf = pdfNarrowCone(versine(light.spec.angularRadiusRad));
  else
    radianceAtInfinity(index, towards, pdf);
  return kPi * pdf / silhouetteArea(scene_.bounds, towards);
}

PrimarySample LightSet::primarySample(size_t index, Rng& rng) const {
  const Light& light = lights_[index];
  const bool fromPoint = !light.area && light.spec.pointOrSpot();
  PrimarySample at{};
  for (float& u : std::span(at).first(fromPoint ? 2 : 4)) u = rng.next();
  return at;
}

PhotonStart LightSet::emit(size_t index, const PrimarySample& at) const {
  const Light& light = lights_[index];
  const LightSpec& s = light.spec;
  PhotonStart start;
  if (light.area) {
    const auto [p, normal, emission, density] = samplePointOn(light, at[0], at[1]);
    Vec3 n = normal;
    float a = at[2];
    if (light.twoSided) {  // the halves of this dimension are the sides
      const bool back = a < 0.5f;
      if (back) n = -n;
      a = 2.0f * a - (back ? 0.0f : 1.0f);
    }
    start.direction = Frame(n).toWorld(sampleCosineHemisphere(a, at[3]));
    start.origin = accel_.offsetOrigin(p, n);
    start.flux = fluxOf(light, emission) * (1.0f / density);
  } else if (s.type == LightType::Point) {
    start = {s.position, sampleSphere(at[0], at[1]), light.power};
  } else if (s.type == LightType::Spot) {
    const Vec3 d = sampleNarrowCone(at[0], at[1], versine(s.coneRad));
    start.origin = s.position;
    start.direction = Frame(s.direction).toWorld(d);
    const float fromAxis = at[0] * versine(s.coneRad);  // that of the sampled direction
    start.flux = s.emission * (spotFalloff(s, fromAxis) / pdfNarrowCone(versine(s.coneRad)));
  } else {
    start = emitFromInfinity(light, at);
  }
  return start;
}

}  // namespace bnvpl
