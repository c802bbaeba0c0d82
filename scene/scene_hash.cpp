#include "scene/scene_hash.h"

#include <span>
#include <type_traits>

#include "core/hash.h"
#include "scene/visit_material.h"

namespace bnvpl {

namespace {

class SceneHasher {
 public:
  template <typename T>
  void value(const T& v) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float> ||
                  std::is_same_v<T, Vec3>);  // padding bytes are not content
    hasher_.add(bytesOf(v));
  }
  template <typename T>
  void array(const std::vector<T>& v) {
    value(uint64_t{v.size()});
    hasher_.add(std::as_bytes(std::span(v)));
  }
  uint64_t digest() const { return hasher_.digest(); }

 private:
  Hasher hasher_;
};

void hashModel(SceneHasher& h, const Material& m) {
  h.value(std::visit([](const auto& model) { return model.kHashId; }, m.model));
  struct Inputs {
    SceneHasher& h;
    void operator()(const Colour& c) const { h.value(c.value), h.value(c.texture); }
    void operator()(const Scalar& s) const { h.value(s.value), h.value(s.texture); }
    void operator()(uint32_t number) const { h.value(number); }
  };
  forEachInput(m, Inputs{h});
  for (const float f : {m.opacityCutoff, m.relief.strength}) h.value(f);
  h.value(uint32_t{m.relief.heightInTexels});
  if (m.coatRelief.flat()) return;
  for (const uint32_t i : {m.coatRelief.normalMap, m.coatRelief.bumpMap}) h.value(i);
  h.value(m.coatRelief.strength);
  h.value(uint32_t{m.coatRelief.heightInTexels});
}

void hashMaterial(SceneHasher& h, const Material& m) {
  static const PhongModel kNoPhong;
  const auto* phong = std::get_if<PhongModel>(&m.model);
  const PhongModel& p = phong ? *phong : kNoPhong;
  for (const Vec3 v : {p.diffuse, p.glossy, p.mirror, p.transmission, m.emission}) h.value(v);
  for (const float f : {p.exponent, p.ior, m.opacity}) h.value(f);
  for (const uint32_t i : {p.diffuseMap, p.glossyMap, m.opacityMap}) h.value(i);
  // Fields that MTL lacks are hashed only if used, which leaves the hash of other materials alone.
  bool more = !phong || m.opacityCutoff != 0.5f;
  forEachExpression(m, [&](uint32_t number) { more |= number != kNone; });
  h.value(uint32_t{p.glass} | uint32_t{m.twoSidedEmission} << 1 | uint32_t{more} << 2);
  if (more) hashModel(h, m);
}

void hashExpressions(SceneHasher& h, const std::vector<TextureExpression>& expressions) {
  for (const TextureExpression& e : expressions) {
    for (const uint32_t i :
         {static_cast<uint32_t>(e.kind), e.image, static_cast<uint32_t>(e.channel),
          static_cast<uint32_t>(e.wrapU), static_cast<uint32_t>(e.wrapV), uint32_t{e.invert},
          e.first, e.second, e.amount})
      h.value(i);
    h.value(e.value);
    for (const float f : {e.uv.a, e.uv.b, e.uv.c, e.uv.d, e.uv.e, e.uv.f}) h.value(f);
  }
}

}  // namespace

uint64_t hashScene(const Scene& scene) {
  SceneHasher h;
  h.array(scene.positions);
  h.array(scene.normals);
  h.array(scene.uvs);
  h.array(scene.triangles);
  h.value(uint64_t{scene.materials.size()});
  for (const Material& m : scene.materials) {
    hashMaterial(h, m);
  }
  hashExpressions(h, scene.expressions);
  h.value(uint64_t{scene.textures.size()});
  for (const Texture& t : scene.textures) {
    for (const uint32_t i : {t.width, t.height, uint32_t{t.srgb}}) h.value(i);
    for (const float f : {t.scale[0], t.scale[1], t.offset[0], t.offset[1]}) h.value(f);
    h.array(t.rgba);
    if (!t.floats.empty()) h.array(t.floats);
  }
  h.value(uint64_t{scene.lights.size()});
  for (const LightSpec& l : scene.lights) {
    h.value(static_cast<uint32_t>(l.type));
    for (const Vec3 v : {l.position, l.direction, l.emission}) h.value(v);
    for (const float f : {l.coneRad, l.falloffRad, l.angularRadiusRad, l.rotateRad, l.scale})
      h.value(f);
    h.value(l.image);
  }
  h.value(uint64_t{scene.environments.size()});
  for (const EnvironmentImage& e : scene.environments) {
    h.value(e.width);
    h.value(e.height);
    h.array(e.radiance);
  }
  if (!scene.instances.empty()) {  // leaves the hash of other scenes alone
    h.array(scene.prototypes);
    h.array(scene.instances);
  }
  if (scene.lightGroups.size() > 1) {  // the same
    for (const std::string& name : scene.lightGroups)
      h.array(std::vector<char>(name.begin(), name.end()));
    for (const Material& m : scene.materials) h.value(m.lightGroup);
    for (const LightSpec& l : scene.lights) h.value(l.group);
  }
  return h.digest();
}

uint64_t hashView(const Camera& c, const Film& film) {
  SceneHasher h;
  for (const Vec3 v : {c.position, c.forward, c.right, c.up}) h.value(v);
  h.value(c.verticalFovRad);
  if (c.shift != std::array<float, 2>{}) h.value(c.shift[0]), h.value(c.shift[1]);
  if (c.hasLens()) h.value(c.lensRadius), h.value(c.focusDistance);
  h.value(film.width);
  h.value(film.height);
  return h.digest();
}

}  // namespace bnvpl
