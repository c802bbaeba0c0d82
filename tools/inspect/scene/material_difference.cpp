#include "tools/inspect/scene/material_difference.h"

#include <algorithm>
#include <cmath>

#include "scene/visit_material.h"

namespace bnvpl {

namespace {

// The parameters of a material, in a fixed order.
struct Parts {
  std::vector<float> numbers;
  std::vector<uint32_t> expressions, images, materials;

  void add(Vec3 v) { numbers.insert(numbers.end(), {v.x, v.y, v.z}); }
  void add(float f) { numbers.push_back(f); }
  void add(const Colour& c) { add(c.value), expressions.push_back(c.texture); }
  void add(const Scalar& s) { add(s.value), expressions.push_back(s.texture); }
  void add(bool on) { add(on ? 1.0f : 0.0f); }
  void add(Roughness::Alpha a) { add(static_cast<float>(a)); }
  void add(uint32_t material) { materials.push_back(material); }
};

void addPhong(const PhongModel& p, Parts& parts) {
  for (const Vec3 v : {p.diffuse, p.glossy, p.mirror, p.transmission}) parts.add(v);
  for (const float f : {p.exponent, p.ior}) parts.add(f);
  parts.add(p.glass);
  parts.images = {p.diffuseMap, p.glossyMap};
}

void addRelief(const Relief& r, Parts& parts) {
  parts.expressions.insert(parts.expressions.end(), {r.normalMap, r.bumpMap});
  if (r.flat()) return;
  parts.add(r.strength);
  parts.add(r.heightInTexels);
}

Parts partsOf(const Material& m) {
  Parts parts;
  if (const auto* phong = std::get_if<PhongModel>(&m.model)) addPhong(*phong, parts);
  const auto field = [&](const char*, const auto& value) { parts.add(value); };
  std::visit([&](const auto& model) { forEachField(model, field); }, m.model);
  parts.add(m.emission);
  const bool lamp = !isBlack(m.emission);  // the rest of its emission does not matter otherwise
  parts.add(lamp && m.twoSidedEmission);
  parts.add(m.opacityCutoff);
  parts.add(m.masked());
  parts.expressions.push_back(lamp ? m.emissionTexture : kNone);
  addRelief(m.relief, parts);
  addRelief(m.coatRelief, parts);
  return parts;
}

bool near(float a, float b, float tolerance) {
  return std::fabs(a - b) <= tolerance * std::max({1.0f, std::fabs(a), std::fabs(b)});
}
bool nearNumber(float a, float b) { return near(a, b, 1e-6f); }
bool nearTexel(Vec3 a, Vec3 b) {
  constexpr float kTexel = 2e-3f;  // tolerance for coordinates rounded within a texel
  return near(a.x, b.x, kTexel) && near(a.y, b.y, kTexel) && near(a.z, b.z, kTexel);
}

// Compares two functions at points spread over [-1, 2]^2.
template <typename A, typename B>
bool sameOverPlane(const A& a, const B& b) {
  constexpr int kPlaces = 64;
  for (int i = 0; i < kPlaces; ++i) {
    const float u = std::fmod(0.7548777f * float(i), 1.0f) * 3.0f - 1.0f;
    const float v = std::fmod(0.5698403f * float(i), 1.0f) * 3.0f - 1.0f;
    if (!nearTexel(a(u, v), b(u, v))) return false;
  }
  return true;
}

bool sameExpressions(const Scene& a, uint32_t i, const Scene& b, uint32_t j) {
  if ((i == kNone) != (j == kNone)) return false;
  return sameOverPlane([&](float u, float v) { return a.expressionAt(i, u, v); },
                       [&](float u, float v) { return b.expressionAt(j, u, v); });
}

bool sameImages(const Scene& a, uint32_t i, const Scene& b, uint32_t j) {
  if (i == kNone || j == kNone) return i == j;
  return sameOverPlane([&](float u, float v) { return a.textures[i].lookup(u, v); },
                       [&](float u, float v) { return b.textures[j].lookup(u, v); });
}

Vec3 opacityAt(const Scene& scene, const Material& m, float u, float v) {
  float opacity = m.opacity * scene.expressionAt(m.opacityTexture, u, v).x;
  if (m.opacityMap != kNone) opacity *= scene.textures[m.opacityMap].lookupAlpha(u, v);
  return Vec3(opacity);
}

}  // namespace

bool sameMaterial(const MaterialOf& material, const MaterialOf& again) {
  const Scene &a = material.scene, &b = again.scene;
  const Material &m = *material, &n = *again;
  if (m.model.index() != n.model.index()) return false;
  if (a.lightGroups[m.lightGroup] != b.lightGroups[n.lightGroup]) return false;
  const Parts p = partsOf(m), q = partsOf(n);
  const auto part = [&](uint32_t i, uint32_t j) {
    return i == kNone || j == kNone ? i == j : sameMaterial({a, i}, {b, j});
  };
  const auto expression = [&](uint32_t i, uint32_t j) { return sameExpressions(a, i, b, j); };
  const auto image = [&](uint32_t i, uint32_t j) { return sameImages(a, i, b, j); };
  return std::ranges::equal(p.numbers, q.numbers, nearNumber) &&
         std::ranges::equal(p.expressions, q.expressions, expression) &&
         std::ranges::equal(p.images, q.images, image) &&
         std::ranges::equal(p.materials, q.materials, part) &&
         sameOverPlane([&](float u, float v) { return opacityAt(a, m, u, v); },
                       [&](float u, float v) { return opacityAt(b, n, u, v); });
}

}  // namespace bnvpl
