#include "scene/read/pbrt/materials.h"

#include <set>
#include <tuple>

#include "core/number_text.h"
#include "scene/read/pbrt/textures.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kDeepestMix = 16;
constexpr float kCoatThickness = 0.01f;  // pbrt's default
constexpr float kMaxThickness = 100.0f;  // that of MaterialInputs::thickness()

bool isInterface(const std::string& type) {
  return type == "interface" || type == "none" || type.empty();
}

}  // namespace

class Materials::Maker {
 public:
  Maker(const LightReader& reader, SceneBuilder& builder)
      : r_(reader),
        builder_(builder),
        textures_(reader.description, reader.folder, reader.colors, reader.notes, builder) {}

  // The material without emission and alpha; nothing for an interface.
  const std::optional<Material>& base(const MaterialRef& ref);
  uint32_t of(const Shape& shape, const ShapeEmission& emission);
  void noteUnused() const;

 private:
  const Entity* entityOf(const MaterialRef& ref);
  std::optional<Material> make(const MaterialRef& ref);
  std::optional<MaterialModel> modelOf(const Entity& e);
  uint32_t componentOf(const std::string& name, const Place& place);
  void setAlpha(const Shape& shape, Material& m);
  void setRelief(const Entity& e, Material& m);
  Roughness roughness(const Params& p, const std::string& prefix = "");
  ConductorFresnel conductor(const Params& p, const std::string& prefix = "");
  void ignoreMedium(const Entity& e);
  MaterialModel conductorModel(const Entity& e);
  MaterialModel coatedConductor(const Entity& e);
  MaterialModel dielectric(const Entity& e, bool thin);
  MaterialModel diffuseTransmission(const Entity& e);
  std::optional<MaterialModel> mix(const Entity& e);

  const LightReader& r_;
  SceneBuilder& builder_;
  Textures textures_;
  std::map<MaterialRef, std::optional<Material>> bases_;
  std::set<MaterialRef> making_;
  std::map<std::string, uint32_t> components_;  // materials within mixes
  using Key = std::tuple<MaterialRef, std::array<float, 3>, bool, fs::path, std::string>;
  std::map<Key, uint32_t> numbers_;
};

const Entity* Materials::Maker::entityOf(const MaterialRef& ref) {
  if (ref.name.empty())
    return ref.number == kNone ? nullptr : &r_.description.materials[ref.number];
  const auto known = r_.description.namedMaterials.find(ref.name);
  if (known != r_.description.namedMaterials.end()) return &known->second;
  r_.notes.add(ref.place, "there is no material '" + ref.name + "'; what has it is grey");
  return nullptr;
}

const std::optional<Material>& Materials::Maker::base(const MaterialRef& ref) {
  const auto known = bases_.find(ref);
  if (known != bases_.end()) return known->second;
  if (!making_.insert(ref).second) failAt(ref.place, "material '" + ref.name + "' contains itself");
  if (making_.size() > kDeepestMix) failAt(ref.place, "mixes lie more than 16 deep in each other");
  std::optional<Material> made = make(ref);
  making_.erase(ref);
  return bases_[ref] = std::move(made);
}

std::optional<Material> Materials::Maker::make(const MaterialRef& ref) {
  Material m;
  m.model = DiffuseModel{};
  const Entity* e = entityOf(ref);
  if (!e) {
    m.name = ref.name.empty() ? "default" : ref.name;
    return m;
  }
  m.name = ref.name.empty() ? e->type + " of line " + std::to_string(e->place.line) : ref.name;
  std::optional<MaterialModel> model = modelOf(*e);
  if (!model) return std::nullopt;
  m.model = std::move(*model);
  setRelief(*e, m);
  return m;
}

std::optional<MaterialModel> Materials::Maker::modelOf(const Entity& e) {
  const Params& p = e.params;
  p.ignore({"type"});
  if (isInterface(e.type)) return std::nullopt;
  if (e.type == "mix") return mix(e);
  if (e.type == "diffuse") return DiffuseModel{textures_.colour(p, "reflectance", Vec3{0.5f})};
  if (e.type == "diffusetransmission") return diffuseTransmission(e);
  if (e.type == "conductor") return conductorModel(e);
  if (e.type == "coatedconductor") return coatedConductor(e);
  if (e.type == "dielectric" || e.type == "thindielectric")
    return dielectric(e, e.type == "thindielectric");
  if (e.type == "coateddiffuse") {
    ignoreMedium(e);
    CoatedDiffuseModel m;
    m.reflectance = textures_.colour(p, "reflectance", Vec3{0.5f});
    m.ior = Scalar(float(r_.colors.coatIor(p, "eta", 1.5)));
    m.roughness = roughness(p);
    m.thickness = textures_.scalar(p, "thickness", kCoatThickness, kMaxThickness);
    return m;
  }
  r_.notes.add(e.place, "material '" + e.type + "' is not read; what has it is diffuse");
  const Param* own = p.find("reflectance");
  const Colour colour = textures_.colour(p, "reflectance", Vec3{0.5f});
  for (const Param* each : p.all()) p.ignore({each->name.c_str()});
  return DiffuseModel{own ? colour : Colour(Vec3{0.5f})};
}

Roughness Materials::Maker::roughness(const Params& p, const std::string& prefix) {
  const Scalar both = textures_.scalar(p, prefix + "roughness", 0.0f);
  const auto along = [&](const std::string& name) {
    return p.has(name) ? textures_.scalar(p, name, 0.0f) : both;
  };
  const bool remap = p.boolean("remaproughness", true);
  return {along(prefix + "uroughness"), along(prefix + "vroughness"),
          remap ? Roughness::Alpha::Root : Roughness::Alpha::Same};
}

ConductorFresnel Materials::Maker::conductor(const Params& p, const std::string& prefix) {
  ConductorFresnel f;
  const std::string eta = prefix + "eta", k = prefix + "k";
  // Files of coated conductors have the name with and without the prefix.
  const std::string reflectance =
      p.has(prefix + "reflectance") ? prefix + "reflectance" : "reflectance";
  if (p.has(reflectance)) {
    if (p.has(eta) || p.has(k))
      failAt(*p.placeOf(reflectance), "the metal has a 'reflectance' and 'eta' or 'k'; use one");
    f.byReflectance = true;
    f.reflectance = textures_.colour(p, reflectance, Vec3{0.9f});
    return f;
  }
  const auto textured = [&](const std::string& name) {
    const Param* own = p.find(name);
    return own && own->type == ParamType::Texture;
  };
  if (textured(eta) || textured(k)) {
    f.eta = textures_.unboundedColour(p, eta, f.eta.value);
    f.k = textures_.unboundedColour(p, k, f.k.value);
    return f;
  }
  const MetalRgb metal = r_.colors.metal(p, eta, k);
  f.eta = metal.eta;
  f.k = metal.k;
  return f;
}

MaterialModel Materials::Maker::conductorModel(const Entity& e) {
  ConductorModel m;
  m.fresnel = conductor(e.params);
  m.roughness = roughness(e.params);
  m.multipleScattering = false;  // pbrt has none
  return m;
}

MaterialModel Materials::Maker::coatedConductor(const Entity& e) {
  ignoreMedium(e);
  const Params& p = e.params;
  CoatedConductorModel m;
  m.fresnel = conductor(p, "conductor.");
  m.roughness = roughness(p, "conductor.");
  m.coatIor = Scalar(float(r_.colors.coatIor(p, "interface.eta", 1.5)));
  m.coatRoughness = roughness(p, "interface.");
  m.coatThickness = textures_.scalar(p, "thickness", kCoatThickness, kMaxThickness);
  return m;
}

MaterialModel Materials::Maker::dielectric(const Entity& e, bool thin) {
  DielectricModel m;
  m.ior = Scalar(float(r_.colors.ior(e.params, "eta", 1.5)));
  m.thin = thin;
  if (!thin) m.roughness = roughness(e.params);
  return m;
}

MaterialModel Materials::Maker::diffuseTransmission(const Entity& e) {
  const Params& p = e.params;
  const float scale = float(p.number("scale", 1.0, 0.0, 1e6));
  DiffuseTransmissionModel m{textures_.colour(p, "reflectance", Vec3{0.25f}),
                             textures_.colour(p, "transmittance", Vec3{0.25f})};
  m.reflectance.value *= scale;
  m.transmittance.value *= scale;
  return m;
}

// Ignores what scatters between coat and base; the coat's thickness absorbs.
void Materials::Maker::ignoreMedium(const Entity& e) {
  const Param* albedo = e.params.find("albedo");
  if (albedo && !(albedo->type != ParamType::Texture && isBlack(r_.colors.unbounded(*albedo)))) {
    r_.notes.add(albedo->place,
                 "the medium between coat and base ('albedo') is not rendered: the coat is clear");
  }
  e.params.ignore({"g", "maxdepth", "nsamples"});
}

uint32_t Materials::Maker::componentOf(const std::string& name, const Place& place) {
  const auto known = components_.find(name);
  if (known != components_.end()) return known->second;
  std::optional<Material> m = base({name, kNone, place});
  if (m && !m->relief.flat()) {
    r_.notes.add(place, "a mix has no relief: that of '" + name + "' is left out");
    m->relief = {};
  }
  return components_[name] = m ? builder_.addMaterial(*m) : kNone;
}

std::optional<MaterialModel> Materials::Maker::mix(const Entity& e) {
  const Param* names = e.params.find("materials", {ParamType::String}, "two strings");
  if (!names || names->strings.size() != 2)
    failAt(e.place, "a mix needs \"string materials\" with two names");
  const uint32_t first = componentOf(names->strings[0], names->place),
                 second = componentOf(names->strings[1], names->place);
  const Scalar amount = textures_.scalar(e.params, "amount", 0.5f);
  if (first == kNone || second == kNone) {
    r_.notes.add(e.place, "a mix with an interface is taken as its other material");
    const uint32_t other = first == kNone ? 1 : 0;
    const std::optional<Material>& m = base({names->strings[other], kNone, names->place});
    if (!m) return std::nullopt;
    return m->model;
  }
  return MixModel{first, second, amount};
}

void Materials::Maker::setRelief(const Entity& e, Material& m) {
  const std::string normals = e.params.text("normalmap");
  if (!normals.empty())
    m.relief.normalMap = textures_.image((r_.folder / normals).lexically_normal(), false);
  const uint32_t height = textures_.floatTexture(e.params, "displacement");
  if (m.relief.normalMap == kNone) {
    m.relief.bumpMap = height;
  } else if (height != kNone) {
    r_.notes.add(e.place, "the material has a normal map and a displacement; the map counts");
  }
}

void Materials::Maker::setAlpha(const Shape& shape, Material& m) {
  const Param* alpha = shape.params.find("alpha");
  if (!alpha) return;
  if (alpha->type != ParamType::Texture) {
    m.opacity = textures_.scalar(shape.params, "alpha", 1.0f).value;
  } else if (const auto mask = textures_.mask(shape.params, "alpha")) {
    m.opacityMap = mask->image;
    m.opacityCutoff = mask->cutoff;
    return;
  } else {
    m.opacityTexture = textures_.floatTexture(shape.params, "alpha");
    const auto constant = builder_.constantValue(m.opacityTexture);
    if (!constant) return;
    m.opacity = constant->x;
    m.opacityTexture = kNone;
  }
  if (m.opacity > 0.0f && m.opacity < 1.0f) {
    r_.notes.add(alpha->place, "'alpha' " + shortestText(m.opacity) +
                                   ": from 0.5 on the surface is opaque, below it is not there");
  }
  if (m.opacity <= 0.0f && !isBlack(m.emission))
    r_.notes.add(alpha->place, "a lamp of 'alpha' 0, which shines unseen, is left out");
}

uint32_t Materials::Maker::of(const Shape& shape, const ShapeEmission& emission) {
  const std::optional<Material>& base = this->base(shape.material);
  if (!base) return kNone;
  const Param* alpha = shape.params.find("alpha");
  std::string alphaKey;
  if (alpha && alpha->type == ParamType::Texture && !alpha->strings.empty())
    alphaKey = alpha->strings[0];
  else if (alpha && !alpha->numbers.empty())
    alphaKey = std::to_string(alpha->numbers[0]) + "#";
  const Vec3 e = emission.radiance;
  const Key key{shape.material, {e.x, e.y, e.z}, emission.twoSided, emission.image, alphaKey};
  const auto known = numbers_.find(key);
  if (known != numbers_.end()) return known->second;
  Material m = *base;
  const Material* replacement = builder_.useReplacement(m.name);
  // A lamp of pbrt shines whatever its material is, unless the replacement states an emission.
  const bool shines = replacement && !isBlack(e) && isBlack(replacement->emission);
  if (shines) m = *replacement;
  m.emission = e;
  m.twoSidedEmission = emission.twoSided;
  if (!emission.image.empty()) {
    m.emissionTexture =
        textures_.image(emission.image, true, Wrap::Clamp, "the lamp does not shine");
    if (m.emissionTexture == kNone) m.emission = {};
  }
  if (shines) return numbers_[key] = builder_.addOwnMaterial(std::move(m));
  setAlpha(shape, m);
  return numbers_[key] = builder_.addMaterial(std::move(m));
}

void Materials::Maker::noteUnused() const {
  textures_.noteUnused();
  for (const auto& [ref, made] : bases_) {
    if (ref.name.empty() && ref.number == kNone) continue;
    const auto known = r_.description.namedMaterials.find(ref.name);
    const Entity* e = ref.name.empty() ? &r_.description.materials[ref.number]
                      : known != r_.description.namedMaterials.end() ? &known->second
                                                                     : nullptr;
    if (!e || isInterface(e->type)) continue;
    for (const Param* p : e->params.unused()) {
      r_.notes.add(p->place, "material \"" + e->type + "\": parameter '" + p->name +
                                 "' is unknown and ignored");
    }
  }
}

Materials::Materials(const LightReader& reader, SceneBuilder& builder)
    : maker_(std::make_unique<Maker>(reader, builder)) {}
Materials::~Materials() = default;
void Materials::expect(const Shape& shape) { maker_->base(shape.material); }
uint32_t Materials::of(const Shape& shape, const ShapeEmission& emission) {
  return maker_->of(shape, emission);
}
void Materials::noteUnused() const { maker_->noteUnused(); }

}  // namespace bnvpl::pbrt
