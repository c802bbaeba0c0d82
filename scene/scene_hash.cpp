#include "scene/scene_hash.h"

#include <xxhash.h>

#include <memory>
#include <span>
#include <type_traits>

namespace bnvpl {

namespace {

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(state_.get()); }

  template <typename T>
  void value(const T& v) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float> ||
                  std::is_same_v<T, Vec3>);  // no padding bytes, which are not content
    XXH3_64bits_update(state_.get(), &v, sizeof v);
  }
  template <typename T>
  void array(const std::vector<T>& v) {
    value(uint64_t{v.size()});
    XXH3_64bits_update(state_.get(), v.data(), v.size() * sizeof(T));
  }
  uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

}  // namespace

uint64_t hashScene(const Scene& scene) {
  Hasher h;
  h.array(scene.positions);
  h.array(scene.normals);
  h.array(scene.uvs);
  h.array(scene.triangles);
  h.value(uint64_t{scene.materials.size()});
  for (const Material& m : scene.materials) {
    for (const Vec3 v : {m.diffuse, m.glossy, m.mirror, m.transmission, m.emission}) h.value(v);
    for (const float f : {m.exponent, m.ior, m.opacity}) h.value(f);
    for (const uint32_t i : {m.diffuseMap, m.glossyMap, m.opacityMap}) h.value(i);
    h.value(uint32_t{m.glass} | uint32_t{m.twoSidedEmission} << 1);
  }
  h.value(uint64_t{scene.textures.size()});
  for (const Texture& t : scene.textures) {
    for (const uint32_t i : {t.width, t.height, uint32_t{t.srgb}}) h.value(i);
    for (const float f : {t.scale[0], t.scale[1], t.offset[0], t.offset[1]}) h.value(f);
    h.array(t.rgba);
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
  return h.digest();
}

uint64_t hashView(const Camera& c, const Film& film) {
  Hasher h;
  for (const Vec3 v : {c.position, c.forward, c.right, c.up}) h.value(v);
  h.value(c.verticalFovRad);
  h.value(film.width);
  h.value(film.height);
  return h.digest();
}

}  // namespace bnvpl
