#include <algorithm>

#include "core/number_text.h"
#include "tools/common/files/json_text.h"
#include "tools/inspect/scene/write_scene.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

constexpr float kF0PerKs = 0.08f;  // reflectance at normal incidence (docs/scene-format.md)

std::string triple(Vec3 v) {
  return shortestText(v.x) + " " + shortestText(v.y) + " " + shortestText(v.z);
}

std::string mapLine(const Scene& scene, const std::string& key, const TextureExpression& e,
                    WrittenMaterials& used) {
  if (e.kind != TextureExpression::Kind::Image || e.image == kNone) return "";
  used.textures.insert(e.image);
  const auto option = [](const char* name, float u, float v) {
    return std::string(name) + shortestText(u) + " " + shortestText(v) + " 0 ";
  };
  const UvTransform uv = uvOfImage(scene, e);
  std::string line = key + " ";
  if (uv.a != 1.0f || uv.e != 1.0f) line += option("-s ", uv.a, uv.e);
  if (uv.c != 0.0f || uv.f != 0.0f) line += option("-o ", uv.c, uv.f);
  return line + textureFile(scene, e.image) + "\n";
}
std::string imageLine(const Scene& scene, const std::string& key, uint32_t image,
                      WrittenMaterials& used) {
  return mapLine(scene, key, imageExpression(image), used);
}
std::string textureLine(const Scene& scene, const std::string& key, uint32_t expression,
                        WrittenMaterials& used) {
  return expression == kNone ? "" : mapLine(scene, key, scene.expressions[expression], used);
}

std::string facetsText(const MetallicRoughnessModel& m, const PhongModel& p) {
  return "illum 2\nKd " + triple(p.diffuse) + "\nKs " +
         triple(m.specularColour.value * (1.0f / kF0PerKs)) + "\nPr " +
         shortestText(m.roughness.value) + "\nPm " + shortestText(m.metallic.value) + "\nPc " +
         shortestText(m.clearcoat.value) + "\nPcr " + shortestText(m.clearcoatRoughness.value) +
         "\naniso " + shortestText(m.anisotropy.value) + "\nanisor " +
         shortestText(m.anisotropyTurns.value) + "\n";
}

std::string phongText(const PhongModel& p) {
  if (p.glass) {
    return "illum 7\nNi " + shortestText(p.ior) + "\nTf " + triple(p.transmission) + "\nKs " +
           triple(p.mirror) + "\nNs " + shortestText(p.exponent) + "\n";
  }
  const bool mirror = !isBlack(p.mirror);
  return "illum " + std::string(mirror ? "3" : "2") + "\nKd " + triple(p.diffuse) + "\nKs " +
         triple(mirror ? p.mirror : p.glossy) + "\nNs " + shortestText(p.exponent) + "\n";
}

// Properties that are written only for materials that MTL can express exactly.
std::string moreText(const Scene& scene, const Material& m, WrittenMaterials& used) {
  std::string text = textureLine(scene, "map_Ke", m.emissionTexture, used);
  if (m.twoSidedEmission) text += "emission_sides 2\n";
  if (m.opacity != 1.0f) text += "d " + shortestText(m.opacity) + "\n";
  return text + textureLine(scene, "norm", m.relief.normalMap, used) +
         textureLine(scene, "map_Bump -bm " + shortestText(m.relief.strength), m.relief.bumpMap,
                     used);
}

std::string materialText(const Scene& scene, const Material& m, WrittenMaterials& used) {
  const MtlModel nearest = modelToMtl(scene, m.model);
  const PhongModel& p = nearest.phong;
  std::string text = nearest.facets ? facetsText(*nearest.facets, p) : phongText(p);
  if (!isBlack(m.emission)) text += "Ke " + triple(m.emission) + "\n";
  if (nearest.exact) text += moreText(scene, m, used);
  if (p.glass) return text;
  return text + imageLine(scene, "map_Kd", p.diffuseMap, used) +
         imageLine(scene, "map_Ks", p.glossyMap, used) +
         imageLine(scene, "map_d", m.opacityMap, used);
}

// Replaces characters that have a meaning of their own in OBJ and MTL.
std::string cleanName(std::string name) {
  for (char& c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f || c == '\\' || c == '#') c = '_';
  }
  name = parseJson(jsonText(name));  // replaces bytes that are not UTF-8
  const size_t first = std::min(name.find_first_not_of(' '), name.size());
  return name.substr(first, name.find_last_not_of(' ') + 1 - first);
}

std::vector<std::string> uniqueNames(const std::vector<std::string>& given) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const std::string& each : given) {
    const std::string name = cleanName(each), shown = name.empty() ? "unnamed" : name;
    const std::string numbered = shown + " (" + std::to_string(names.size());
    std::string own = shown;
    for (size_t copy = 1; !taken.insert(own).second; ++copy)
      own = numbered + (copy > 1 ? ", " + std::to_string(copy) : "") + ")";
    names.push_back(own);
  }
  return names;
}

}  // namespace

std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.name);
  return uniqueNames(names);
}

std::vector<std::string> objectNames(const Scene& scene) { return uniqueNames(scene.objectNames); }

std::string mtlText(const Scene& scene, WrittenMaterials& used) {
  std::string text =
      "# scene.toml states the materials that MTL cannot; here they are the nearest that it can.\n";
  for (const uint32_t i : used.materials) {
    text += "newmtl " + used.names[i] + "\n" + materialText(scene, scene.materials[i], used);
  }
  return text;
}

}  // namespace bnvpl
