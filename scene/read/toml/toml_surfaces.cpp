#include "scene/read/toml/toml_surfaces.h"

#include <algorithm>
#include <optional>

#include "scene/read/toml/toml_ranges.h"
#include "scene/visit_material.h"

namespace bnvpl {

namespace {

constexpr double kMax = TomlSection::kMaxMagnitude;
// Largest factor of a texture: radiance times several of them stays finite.
constexpr double kMaxFactor = 1e6;

float number(const TomlSection& s, const std::string& key, float otherwise) {
  return static_cast<float>(s.number(key.c_str(), -kMax, kMax, double{otherwise}));
}

// Index of a key's text in `names`; `otherwise` without the key.
template <typename Names>
uint32_t choice(const TomlSection& s, const char* key, const Names& names, uint32_t otherwise) {
  return s.has(key) ? s.choice(key, names) : otherwise;
}

UvTransform readUvTransform(const TomlSection& s) {
  if (!s.has("uv_transform")) return {};
  const auto rows = s.rows("uv_transform", 2, 3);
  const auto at = [&](size_t i, size_t j) { return static_cast<float>(rows[i][j]); };
  return {at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1), at(1, 2)};
}

void readWrap(const TomlSection& s, TextureExpression& e) {
  e.wrapU = static_cast<Wrap>(choice(s, "wrap_u", kWrapNames, 0));
  e.wrapV = static_cast<Wrap>(choice(s, "wrap_v", kWrapNames, 0));
}

// The models that a [[material]] can name. Phong's is left to MTL.
std::vector<MaterialModel> namedModels() {
  std::vector<MaterialModel> models;
  forEachModel([&](const auto& model) {
    if constexpr (!std::same_as<decltype(model), const PhongModel&>) models.emplace_back(model);
  });
  return models;
}

std::vector<std::string> materialKeys(const MaterialModel& model) {
  std::vector<std::string> keys{"name",    "model",          "emission",         "emission_sides",
                                "opacity", "opacity_cutoff", "emission_texture", "opacity_texture"};
  for (const char* prefix : {"", "coat_"}) {
    for (const char* key : {"normal_map", "bump_map", "bump_in_texels", "relief_strength"})
      keys.push_back(std::string(prefix) + key);
  }
  const auto add = [&]<typename Field>(const char* name, const Field&) {
    keys.emplace_back(name);
    if constexpr (kTextured<Field>) keys.push_back(std::string(name) + "_texture");
  };
  std::visit([&](const auto& m) { forEachField(m, add); }, model);
  return keys;
}

}  // namespace

TomlSurfaces::TomlSurfaces(const fs::path& file, const toml::table& root, const FileNames& names,
                           SceneBuilder& builder)
    : file_(file), names_(names), builder_(builder) {
  for (const toml::table* t : tablesOf(file, root, "texture")) {
    readTexture(
        TomlSection(file, "[[texture]]", *t,
                    {"name", "type", "image", "encoding", "channel", "factor", "wrap_u", "wrap_v",
                     "invert", "uv_transform", "value", "first", "second", "amount"}));
  }
  for (const toml::table* t : tablesOf(file, root, "material")) readMaterial(*t);
}

void TomlSurfaces::readTexture(const TomlSection& s) {
  const std::string name = s.newName(textures_);
  TextureExpression e;
  e.kind = static_cast<TextureExpression::Kind>(s.choice("type", kTextureNames));
  const auto require = [&](const std::set<std::string>& keys) {
    s.requireOnly(std::string("a texture of type ") + kTextureNames[static_cast<size_t>(e.kind)],
                  keys);
  };
  switch (e.kind) {
    case TextureExpression::Kind::Constant:
      require({"name", "type", "value"});
      e.value = s.vector("value", kMaxFactor);
      break;
    case TextureExpression::Kind::Image: {
      require({"name", "type", "image", "encoding", "channel", "factor", "wrap_u", "wrap_v",
               "invert", "uv_transform"});
      TextureUse use;
      use.file = names_.resolve(s, "image");
      use.srgb = choice(s, "encoding", kEncodingNames, 0) == 0;
      e.image = builder_.addTexture(use, {SceneBuilder::kPlainColour, s.where("image")});
      e.channel = static_cast<Channel>(choice(s, "channel", kChannelNames, 0));
      if (s.has("factor")) e.value = s.vector("factor", kMaxFactor);
      e.invert = s.flag("invert", false);
      readWrap(s, e);
      break;
    }
    case TextureExpression::Kind::Product:
      require({"name", "type", "first", "second"});
      break;
    case TextureExpression::Kind::Mix:
      require({"name", "type", "first", "second", "amount"});
      break;
    case TextureExpression::Kind::Checkerboard:
      require({"name", "type", "first", "second", "uv_transform"});
      break;
  }
  e.uv = readUvTransform(s);
  e.first = texture(s, "first"), e.second = texture(s, "second"), e.amount = texture(s, "amount");
  textures_[name] = builder_.addExpression(e);
}

uint32_t TomlSurfaces::texture(const TomlSection& s, const std::string& key) const {
  return s.has(key.c_str()) ? s.known(key.c_str(), "[[texture]]", textures_) : kNone;
}

uint32_t TomlSurfaces::material(const TomlSection& s, const char* key) {
  mixed_.insert(s.text(key));
  return s.known(key, "[[material]]", materials_);
}

void TomlSurfaces::readMaterial(const toml::table& table) {
  const auto* model = table.get("model");
  const auto text = model ? model->value_exact<std::string>() : std::nullopt;
  const std::vector<MaterialModel> models = namedModels();
  std::vector<const char*> names;
  for (const MaterialModel& each : models) names.push_back(nameOf(each));
  const auto known = std::ranges::find(names, std::string_view(text.value_or("")));
  Material m;
  if (known != names.end()) m.model = models[static_cast<size_t>(known - names.begin())];
  const TomlSection s(file_, "[[material]]", table, materialKeys(m.model));
  s.choice("model", names);
  m.name = s.newName(materials_);
  struct Fields {
    TomlSurfaces& of;
    const TomlSection& s;
    void operator()(const char* key, Colour& c) const {
      if (s.has(key)) c.value = s.color(key);
      c.texture = of.texture(s, std::string(key) + "_texture");
    }
    void operator()(const char* key, Scalar& x) const {
      x.value = number(s, key, x.value);
      x.texture = of.texture(s, std::string(key) + "_texture");
    }
    void operator()(const char* key, bool& on) const { on = s.flag(key, on); }
    void operator()(const char* key, Roughness::Alpha& a) const {
      a = static_cast<Roughness::Alpha>(choice(s, key, kAlphaNames, static_cast<uint32_t>(a)));
    }
    void operator()(const char* key, uint32_t& material) const { material = of.material(s, key); }
  };
  std::visit([&](auto& parameters) { forEachField(parameters, Fields{*this, s}); }, m.model);
  readCommon(s, m);
  warnOfClamped(s, m, builder_);
  const std::string name = m.name;
  materials_[name] = builder_.addReplacement(std::move(m));
}

void TomlSurfaces::readCommon(const TomlSection& s, Material& m) const {
  if (s.has("emission_texture")) m.emission = Vec3(1);
  if (s.has("emission")) m.emission = s.color("emission");
  m.emissionTexture = texture(s, "emission_texture");
  m.twoSidedEmission = s.has("emission_sides") && s.integer("emission_sides", 1, 2) == 2;
  m.opacity = number(s, "opacity", m.opacity);
  m.opacityCutoff = number(s, "opacity_cutoff", m.opacityCutoff);
  m.opacityTexture = texture(s, "opacity_texture");
  m.relief = readRelief(s, "");
  m.coatRelief = readRelief(s, "coat_");
}

Relief TomlSurfaces::readRelief(const TomlSection& s, const std::string& prefix) const {
  Relief r;
  r.normalMap = texture(s, prefix + "normal_map");
  r.bumpMap = texture(s, prefix + "bump_map");
  r.heightInTexels = s.flag((prefix + "bump_in_texels").c_str(), false);
  r.strength = number(s, prefix + "relief_strength", r.strength);
  if (r.normalMap != kNone && r.bumpMap != kNone)
    s.fail("has '" + prefix + "normal_map' and '" + prefix + "bump_map'; use one of them");
  return r;
}

void TomlSurfaces::warnOfUnused() const {
  for (const auto& [name, number] : materials_) {
    if (builder_.isReplaced(name) || mixed_.contains(name)) continue;
    builder_.warn(file_.string() + ": [[material]] '" + name +
                  "' has no effect: no mesh has a material of that name");
  }
}

}  // namespace bnvpl
