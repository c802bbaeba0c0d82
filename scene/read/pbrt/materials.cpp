#include "scene/read/pbrt/materials.h"

namespace bnvpl::pbrt {

class Materials::Maker {
 public:
  Maker(const LightReader& reader, SceneBuilder& builder) : r_(reader), builder_(builder) {}
  uint32_t of(const Shape& shape, const Emission& emission) {
    Material m;
    m.diffuse = Vec3{0.5f};
    m.emission = emission.radiance;
    m.twoSidedEmission = emission.twoSided;
    (void)r_;
    (void)shape;
    return builder_.addMaterial(m);
  }

 private:
  const LightReader& r_;
  SceneBuilder& builder_;
};

Materials::Materials(const LightReader& reader, SceneBuilder& builder)
    : maker_(std::make_unique<Maker>(reader, builder)) {}
Materials::~Materials() = default;
void Materials::expect(const Shape&) {}
uint32_t Materials::of(const Shape& shape, const Emission& emission) {
  return maker_->of(shape, emission);
}
void Materials::noteUnused() const {}

}  // namespace bnvpl::pbrt
