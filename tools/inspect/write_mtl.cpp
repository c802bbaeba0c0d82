#include <algorithm>
#include <optional>

#include "core/number_text.h"
#include "tools/inspect/write_scene.h"

namespace bnvpl {

namespace {

constexpr float kF0PerKs = 0.08f;  // reflectance at normal incidence (docs/scene-format.md)

std::string triple(Vec3 v) {
  return shortestText(v.x) + " " + shortestText(v.y) + " " + shortestText(v.z);
}

// The image of an expression that is nothing but that image; else kNone.
uint32_t plainImage(const Scene& scene, uint32_t expression) {
  if (expression == kNone) return kNone;
  const TextureExpression& e = scene.expressions[expression];
  const bool plain = e.kind == TextureExpression::Kind::Image && e.channel == Channel::Rgb &&
                     !e.invert && e.value == Vec3(1) && e.wrapU == Wrap::Repeat &&
                     e.wrapV == Wrap::Repeat && e.uv == UvTransform();
  return plain ? e.image : kNone;
}

// What is nearest to each model among Lambert, Phong lobe, mirror, glass, and roughness and metal.
class NearestMtl {
 public:
  explicit NearestMtl(const Scene& scene) : scene_(scene) {}

  PhongModel phong;
  std::optional<MetallicRoughnessModel> facets;  // stated beside Kd, if any; specularColour is f0
  bool same = true;

  void operator()(const PhongModel& m) { phong = m; }
  void operator()(const DiffuseModel& m) { diffuse(m.reflectance, 1.0f); }
  void operator()(const MetallicRoughnessModel& m) {
    if (m.transmission.value > 0.5f) {
      same = false;
      return glass(m.ior.value, m.baseColour.value);
    }
    facets = m;
    const float normal = (m.ior.value - 1.0f) / (m.ior.value + 1.0f);
    facets->specularColour.value = m.specularColour.value * (normal * normal * m.specular.value);
    diffuse(m.baseColour, 1.0f);
    for (const uint32_t texture :
         {m.metallic.texture, m.roughness.texture, m.anisotropy.texture, m.anisotropyTurns.texture,
          m.specular.texture, m.specularColour.texture, m.clearcoat.texture,
          m.clearcoatRoughness.texture})
      same = same && texture == kNone;
    same = same && m.transmission.value == 0.0f &&
           (m.specular.value == 1.0f || m.metallic.value == 1.0f) &&
           maxComponent(facets->specularColour.value) <= kF0PerKs;
  }
  void operator()(const ConductorModel& m) {
    same = false;
    lobe(m.fresnel.byReflectance ? m.fresnel.reflectance.value : Vec3(0.8f),
         m.roughness.along.value);
  }
  void operator()(const CoatedConductorModel& m) {
    same = false;
    lobe(m.fresnel.byReflectance ? m.fresnel.reflectance.value : Vec3(0.8f),
         m.roughness.along.value);
  }
  void operator()(const CoatedDiffuseModel& m) {
    same = false;
    diffuse(m.reflectance, 1.0f);
  }
  void operator()(const DiffuseTransmissionModel& m) {
    same = false;
    diffuse(m.reflectance, 1.0f);
  }
  void operator()(const DielectricModel& m) {
    same = !m.thin && m.roughness.along.value == 0.0f && m.roughness.along.texture == kNone;
    glass(m.ior.value, m.transmission.value);
    phong.mirror = m.reflection.value;
  }
  void operator()(const MixModel& m) {
    same = false;
    std::visit(*this, scene_.materials[m.amount.value < 0.5f ? m.first : m.second].model);
    same = false;
  }

 private:
  void diffuse(const Colour& c, float share) {
    phong.diffuse = share * c.value;
    phong.diffuseMap = plainImage(scene_, c.texture);
    same = same && (c.texture == kNone || phong.diffuseMap != kNone);
  }
  void lobe(Vec3 albedo, float alpha) {
    constexpr float kSmooth = 0.03f, kMostExponent = 9999.0f;
    if (alpha < kSmooth) {
      phong.mirror = albedo;
    } else {
      phong.glossy = albedo;
      phong.exponent = std::min(kMostExponent, std::max(0.0f, 2.0f / (alpha * alpha) - 2.0f));
    }
  }
  void glass(float ior, Vec3 colour) {
    phong.glass = true;
    phong.ior = std::max(1.0f, ior);
    phong.transmission = colour;
    phong.mirror = Vec3(1);
  }

  const Scene& scene_;
};

std::string mapLine(const Scene& scene, const char* key, uint32_t map) {
  if (map == kNone) return "";
  const Texture& t = scene.textures[map];
  const auto option = [](const char* name, const std::array<float, 2>& v) {
    return std::string(name) + shortestText(v[0]) + " " + shortestText(v[1]) + " 0 ";
  };
  std::string line = std::string(key) + " ";
  if (t.scale != std::array<float, 2>{1, 1}) line += option("-s ", t.scale);
  if (t.offset != std::array<float, 2>{0, 0}) line += option("-o ", t.offset);
  return line + "textures/" + std::to_string(map) + ".png\n";
}

std::string facetsText(const Scene& scene, const MetallicRoughnessModel& m, const PhongModel& p) {
  return "illum 2\nKd " + triple(p.diffuse) + "\nKs " +
         triple(m.specularColour.value * (1.0f / kF0PerKs)) + "\nPr " +
         shortestText(m.roughness.value) + "\nPm " + shortestText(m.metallic.value) + "\nPc " +
         shortestText(m.clearcoat.value) + "\nPcr " + shortestText(m.clearcoatRoughness.value) +
         "\naniso " + shortestText(m.anisotropy.value) + "\nanisor " +
         shortestText(m.anisotropyTurns.value) + "\n" + mapLine(scene, "map_Kd", p.diffuseMap);
}

std::string phongText(const Scene& scene, const PhongModel& p) {
  if (p.glass) {
    return "illum 7\nNi " + shortestText(p.ior) + "\nTf " + triple(p.transmission) + "\nKs " +
           triple(p.mirror) + "\n";
  }
  const bool mirror = !isBlack(p.mirror);
  return "illum " + std::string(mirror ? "3" : "2") + "\nKd " + triple(p.diffuse) + "\nKs " +
         triple(mirror ? p.mirror : p.glossy) + "\nNs " + shortestText(p.exponent) + "\n" +
         mapLine(scene, "map_Kd", p.diffuseMap) + mapLine(scene, "map_Ks", p.glossyMap);
}

}  // namespace

std::string mtlName(const Scene& scene, uint32_t material) {
  std::string name = "m" + std::to_string(material) + " " + scene.materials[material].name;
  for (char& c : name) {
    if (c == '\n' || c == '\r' || c == '\\' || c == '#') c = '_';
  }
  return name.substr(0, name.find_last_not_of(" \t") + 1);
}

std::string mtlText(const Scene& scene, std::vector<std::string>& approximated) {
  std::string text;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    NearestMtl nearest(scene);
    std::visit(nearest, m.model);
    text += "newmtl " + mtlName(scene, i) + "\n" +
            (nearest.facets ? facetsText(scene, *nearest.facets, nearest.phong)
                            : phongText(scene, nearest.phong));
    if (!isBlack(m.emission)) text += "Ke " + triple(m.emission) + "\n";
    if (m.twoSidedEmission) text += "emission_sides 2\n";
    if (m.opacity != 1.0f) text += "d " + shortestText(m.opacity) + "\n";
    text += mapLine(scene, "map_d", m.opacityMap);
    const bool same = nearest.same && m.relief.flat() && m.coatRelief.flat() &&
                      m.emissionTexture == kNone && m.opacityTexture == kNone &&
                      m.opacityCutoff == 0.5f;
    if (!same) approximated.push_back("material '" + m.name + "' is more than MTL can say");
  }
  return text;
}

}  // namespace bnvpl
