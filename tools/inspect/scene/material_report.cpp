#include <set>

#include "tools/inspect/scene/scene_report.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

Json colourJson(Vec3 c) { return Json::array({c.x, c.y, c.z}); }

// Collects the images that an expression reads.
void collectImages(const Scene& scene, uint32_t expression, std::set<uint32_t>& images) {
  if (expression == kNone) return;
  const TextureExpression& e = scene.expressions[expression];
  if (e.kind == TextureExpression::Kind::Image && e.image != kNone) images.insert(e.image);
  for (const uint32_t operand : {e.first, e.second, e.amount})
    collectImages(scene, operand, images);
}

class MaterialReport {
 public:
  explicit MaterialReport(const Scene& scene) : scene_(scene) {}

  Json json = Json::object();

  void addModel(const ModelReport& report) {
    json["model"] = report.model;
    for (const auto& [name, parameter] : report.parameters)
      std::visit([&, &key = name](const auto& value) { add(key, value); }, parameter);
  }

  void addShared(const Material& m) {
    if (!isBlack(m.emission)) {
      json["emission"] = colourJson(m.emission);
      textures("emission", m.emissionTexture);
      json["emission_sides"] = m.twoSidedEmission ? 2 : 1;
    }
    if (m.masked()) {
      json["opacity"] = m.opacity;
      json["opacity_cutoff"] = m.opacityCutoff;
      textures("opacity", m.opacityTexture);
      if (m.opacityMap != kNone) json["opacity_textures"] = Json::array({m.opacityMap});
    }
    if (!m.coatRelief.flat()) {
      textures("coat_normal", m.coatRelief.normalMap);
      json["coat_relief_strength"] = m.coatRelief.strength;
    }
    if (m.relief.flat()) return;
    textures("normal", m.relief.normalMap);
    textures("bump", m.relief.bumpMap);
    json["relief_strength"] = m.relief.strength;
    if (m.relief.heightInTexels) json["relief_unit"] = "texels";
  }

 private:
  void textures(const std::string& name, uint32_t expression) {
    std::set<uint32_t> images;
    collectImages(scene_, expression, images);
    if (!images.empty()) json[name + "_textures"] = images;
  }
  void add(const std::string& name, const Colour& c) {
    json[name] = colourJson(c.value);
    textures(name, c.texture);
  }
  void add(const std::string& name, const Scalar& s) {
    json[name] = s.value;
    textures(name, s.texture);
  }
  void add(const std::string& name, const ModelReport::Image& i) {
    json[name] = colourJson(i.value);
    if (i.image != kNone) json[name + "_textures"] = Json::array({i.image});
  }
  template <typename Plain>
  void add(const std::string& name, const Plain& value) {
    json[name] = value;
  }

  const Scene& scene_;
};

}  // namespace

Json describeMaterial(const Scene& scene, const Material& material) {
  MaterialReport report(scene);
  report.json["name"] = material.name;
  report.addModel(describeModel(scene, material.model));
  report.addShared(material);
  return report.json;
}

}  // namespace bnvpl
