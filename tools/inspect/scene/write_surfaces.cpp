#include <algorithm>

#include "core/number_text.h"
#include "scene/visit_material.h"
#include "tools/common/files/json_text.h"
#include "tools/inspect/scene/write_scene.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

// JSON's quotes and escapes are TOML's too.
std::string inQuotes(const std::string& text) { return jsonText(text); }

namespace {

std::string textureName(uint32_t expression) { return "t" + std::to_string(expression); }

template <typename Enum, size_t N>
std::string nameIn(const std::array<const char*, N>& names, Enum value) {
  return inQuotes(names[static_cast<size_t>(value)]);
}

class Surfaces {
 public:
  Surfaces(const Scene& scene, WrittenMaterials& used) : scene_(scene), used_(used) {}

  void material(uint32_t number);
  std::string text() const { return textures_ + materials_; }

 private:
  void add(const std::string& key, const std::string& value) {
    materials_ += key + " = " + value + "\n";
  }
  void addTexture(const std::string& key, uint32_t expression) {
    if (expression == kNone) return;
    texture(expression);
    add(key, inQuotes(textureName(expression)));
  }
  void field(const std::string& key, const Colour& c) {
    add(key, listText(c.value));
    addTexture(key + "_texture", c.texture);
  }
  void field(const std::string& key, const Scalar& s) {
    add(key, shortestText(s.value));
    addTexture(key + "_texture", s.texture);
  }
  void field(const std::string& key, bool on) { add(key, on ? "true" : "false"); }
  void field(const std::string& key, Roughness::Alpha a) { add(key, nameIn(kAlphaNames, a)); }
  void field(const std::string& key, uint32_t mixed) {
    if (mixed != kNone) add(key, inQuotes(used_.names[mixed]));
  }
  void relief(const Relief& r, const std::string& prefix);
  void opacity(const Material& m, uint32_t number);
  void texture(uint32_t expression);
  std::string image(const std::string& name, const TextureExpression& e);

  const Scene& scene_;
  WrittenMaterials& used_;
  std::set<uint32_t> written_;  // expressions of the scene that are written already
  std::string textures_, materials_;
};

void Surfaces::material(uint32_t number) {
  const Material& m = scene_.materials[number];
  materials_ += "\n[[material]]\n";
  add("name", inQuotes(used_.names[number]));
  add("model", inQuotes(nameOf(m.model)));
  const auto each = [&](const char* key, const auto& value) { field(key, value); };
  std::visit([&](const auto& model) { forEachField(model, each); }, m.model);
  if (!isBlack(m.emission)) {
    add("emission", listText(m.emission));
    addTexture("emission_texture", m.emissionTexture);
  }
  if (m.twoSidedEmission) add("emission_sides", "2");
  opacity(m, number);
  relief(m.relief, "");
  relief(m.coatRelief, "coat_");
}

void Surfaces::relief(const Relief& r, const std::string& prefix) {
  if (r.flat()) return;
  addTexture(prefix + "normal_map", r.normalMap);
  addTexture(prefix + "bump_map", r.bumpMap);
  add(prefix + "bump_in_texels", r.heightInTexels ? "true" : "false");
  add(prefix + "relief_strength", shortestText(r.strength));
}

// After loading, opacity masks of MTL and pbrt are the alpha channel of an image.
void Surfaces::opacity(const Material& m, uint32_t number) {
  if (m.opacity != 1.0f) add("opacity", shortestText(m.opacity));
  if (m.opacityCutoff != 0.5f) add("opacity_cutoff", shortestText(m.opacityCutoff));
  if (m.opacityMap == kNone) return addTexture("opacity_texture", m.opacityTexture);
  TextureExpression mask = imageExpression(m.opacityMap, Channel::Alpha);
  const std::string name = "mask of m" + std::to_string(number);
  textures_ += image(name, mask);
  if (m.opacityTexture == kNone) return add("opacity_texture", inQuotes(name));
  texture(m.opacityTexture);
  textures_ += "\n[[texture]]\nname = " + inQuotes("opacity of m" + std::to_string(number)) +
               "\ntype = \"product\"\nfirst = " + inQuotes(name) +
               "\nsecond = " + inQuotes(textureName(m.opacityTexture)) + "\n";
  add("opacity_texture", inQuotes("opacity of m" + std::to_string(number)));
}

std::string uvText(const UvTransform& t) {
  const auto row = [](float a, float b, float c) { return listText(Vec3(a, b, c)); };
  return "uv_transform = [" + row(t.a, t.b, t.c) + ", " + row(t.d, t.e, t.f) + "]\n";
}

std::string Surfaces::image(const std::string& name, const TextureExpression& e) {
  used_.textures.insert(e.image);
  const UvTransform uv = uvOfImage(scene_, e);
  const bool srgb = e.channel != Channel::Alpha && scene_.textures[e.image].srgb;
  return "\n[[texture]]\nname = " + inQuotes(name) +
         "\ntype = \"image\"\nimage = " + inQuotes(textureFile(scene_, e.image)) +
         "\nencoding = " + inQuotes(kEncodingNames[srgb ? 0 : 1]) +
         "\nchannel = " + nameIn(kChannelNames, e.channel) + "\nfactor = " + listText(e.value) +
         "\nwrap_u = " + nameIn(kWrapNames, e.wrapU) + "\nwrap_v = " + nameIn(kWrapNames, e.wrapV) +
         "\n" + (e.invert ? "invert = true\n" : "") + (uv == UvTransform() ? "" : uvText(uv));
}

void Surfaces::texture(uint32_t expression) {
  if (!written_.insert(expression).second) return;
  const TextureExpression& e = scene_.expressions[expression];
  for (const uint32_t operand : {e.first, e.second, e.amount}) {
    if (operand != kNone) texture(operand);
  }
  const std::string name = textureName(expression);
  if (e.kind == TextureExpression::Kind::Image && e.image != kNone) {
    textures_ += image(name, e);
    return;
  }
  const bool white = e.kind == TextureExpression::Kind::Image;  // a missing image reads as 1
  textures_ += "\n[[texture]]\nname = " + inQuotes(name) +
               "\ntype = " + (white ? inQuotes("constant") : nameIn(kTextureNames, e.kind)) + "\n";
  if (white || e.kind == TextureExpression::Kind::Constant) {
    textures_ += "value = " + listText(white ? Vec3(1) : e.value) + "\n";
  }
  const auto operand = [&](const char* key, uint32_t number) {
    if (number != kNone)
      textures_ += std::string(key) + " = " + inQuotes(textureName(number)) + "\n";
  };
  operand("first", e.first), operand("second", e.second), operand("amount", e.amount);
  if (e.kind == TextureExpression::Kind::Checkerboard) textures_ += uvText(e.uv);
}

// Adds a material and, for a mix, its parts.
void addWithParts(const Scene& scene, uint32_t material, std::set<uint32_t>& materials) {
  if (material == kNone || !materials.insert(material).second) return;
  const auto field = [&]<typename Field>(const char*, const Field& part) {
    if constexpr (Like<Field, uint32_t>) addWithParts(scene, part, materials);
  };
  std::visit([&](const auto& model) { forEachField(model, field); },
             scene.materials[material].model);
}

}  // namespace

std::string surfacesText(const Scene& scene, WrittenMaterials& used) {
  std::set<uint32_t> materials;
  for (const uint32_t m : used.materials) {
    if (!modelToMtl(scene, scene.materials[m].model).exact) addWithParts(scene, m, materials);
  }
  Surfaces surfaces(scene, used);
  for (const uint32_t m : materials) surfaces.material(m);
  return surfaces.text();
}

}  // namespace bnvpl
