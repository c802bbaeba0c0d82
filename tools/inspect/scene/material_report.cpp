#include <set>

#include "tools/inspect/scene/scene_report.h"

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

  void operator()(const PhongModel& m) {
    json["model"] = m.glass ? "glass" : "phong";
    if (m.glass) {
      json["ior"] = m.ior;
      json["transmission"] = colourJson(m.transmission);
      json["mirror"] = colourJson(m.mirror);
      return;
    }
    image("diffuse", m.diffuse, m.diffuseMap);
    if (!isBlack(m.glossy) || m.glossyMap != kNone) {
      image("glossy", m.glossy, m.glossyMap);
      json["exponent"] = m.exponent;
    }
    if (!isBlack(m.mirror)) json["mirror"] = colourJson(m.mirror);
  }
  void operator()(const DiffuseModel& m) {
    json["model"] = "diffuse";
    add("reflectance", m.reflectance);
  }
  void operator()(const DiffuseTransmissionModel& m) {
    json["model"] = "diffuse transmission";
    add("reflectance", m.reflectance);
    add("transmittance", m.transmittance);
  }
  void operator()(const ConductorModel& m) {
    json["model"] = "conductor";
    add(m.fresnel);
    add("roughness", m.roughness);
    json["multiple_scattering"] = m.multipleScattering;
  }
  void operator()(const DielectricModel& m) {
    json["model"] = m.thin ? "thin dielectric" : "dielectric";
    add("ior", m.ior);
    add("roughness", m.roughness);
    add("reflection", m.reflection);
    add("transmission", m.transmission);
  }
  void operator()(const CoatedDiffuseModel& m) {
    json["model"] = "coated diffuse";
    add("reflectance", m.reflectance);
    add("ior", m.ior);
    add("roughness", m.roughness);
  }
  void operator()(const CoatedConductorModel& m) {
    json["model"] = "coated conductor";
    add(m.fresnel);
    add("roughness", m.roughness);
    add("coat_ior", m.coatIor);
    add("coat_roughness", m.coatRoughness);
  }
  void operator()(const MetallicRoughnessModel& m) {
    json["model"] = "metallic-roughness";
    add("base_colour", m.baseColour);
    add("metallic", m.metallic);
    add("roughness", m.roughness);
    if (m.anisotropy.value > 0) add("anisotropy", m.anisotropy);
    if (m.anisotropy.value > 0 && m.anisotropyTurns.value != 0)
      add("anisotropy_turns", m.anisotropyTurns);
    add("ior", m.ior);
    if (m.specular.value != 1 || m.specular.texture != kNone) add("specular", m.specular);
    if (m.specularColour.value != Vec3(1) || m.specularColour.texture != kNone)
      add("specular_colour", m.specularColour);
    if (m.clearcoat.value > 0) {
      add("clearcoat", m.clearcoat);
      add("clearcoat_roughness", m.clearcoatRoughness);
    }
    if (m.transmission.value > 0) add("transmission", m.transmission);
  }
  void operator()(const MixModel& m) {
    json["model"] = "mix";
    json["first"] = scene_.materials[m.first].name;
    json["second"] = scene_.materials[m.second].name;
    add("amount", m.amount);
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
  void image(const std::string& name, Vec3 value, uint32_t map) {
    json[name] = colourJson(value);
    if (map != kNone) json[name + "_textures"] = Json::array({map});
  }
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
  void add(const std::string& name, const Roughness& r) {
    static constexpr const char* kAlpha[] = {"roughness", "roughness^2", "sqrt(roughness)"};
    add(name, r.along);
    if (r.across.value != r.along.value || r.across.texture != r.along.texture)
      add(name + "_across", r.across);
    json["alpha"] = kAlpha[static_cast<size_t>(r.alpha)];
  }
  void add(const ConductorFresnel& f) {
    if (f.byReflectance) return add("reflectance", f.reflectance);
    add("eta", f.eta);
    add("k", f.k);
  }

  const Scene& scene_;
};

}  // namespace

Json describeMaterial(const Scene& scene, const Material& material) {
  MaterialReport report(scene);
  report.json["name"] = material.name;
  std::visit(report, material.model);
  report.addShared(material);
  return report.json;
}

}  // namespace bnvpl
