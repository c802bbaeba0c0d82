#include "scene/read/gltf/materials.h"

#include "scene/read/gltf/material_textures.h"
#include "scene/read/see_through.h"

namespace bnvpl {

namespace {

float real(double value) { return static_cast<float>(value); }

Vec3 colourOf(const std::vector<double>& values) {
  return values.size() < 3 ? Vec3(1) : Vec3{real(values[0]), real(values[1]), real(values[2])};
}

Vec3 colourOf(const tinygltf::Value& object, const char* member) {
  if (!object.Has(member)) return Vec3(1);
  const tinygltf::Value& list = object.Get(member);
  const auto at = [&](int i) { return real(list.Get(i).GetNumberAsDouble()); };
  return {at(0), at(1), at(2)};
}

// Returns a null value if the material lacks the extension: all members then have their defaults.
const tinygltf::Value& extensionOf(const tinygltf::Material& material, const char* name) {
  static const tinygltf::Value none;
  const auto it = material.extensions.find(name);
  return it == material.extensions.end() ? none : it->second;
}

class MaterialReader {
 public:
  // `shown` is the material in messages.
  MaterialReader(const GltfModel& model, const tinygltf::Material& from, const std::string& shown,
                 SceneBuilder& builder)
      : model_(model),
        from_(from),
        shown_(shown),
        builder_(builder),
        textures_(model, builder, shown) {}

  GltfSurface add() {
    Material m;
    m.name = from_.name;
    const GltfTextureRef base(from_.pbrMetallicRoughness.baseColorTexture);
    const Vec3 factor = colourOf(from_.pbrMetallicRoughness.baseColorFactor);
    const Colour baseColour(factor, textures_.colour(base));
    m.twoSidedEmission = from_.doubleSided;
    if (from_.extensions.contains("KHR_materials_unlit")) {
      m.model = DiffuseModel{Colour(Vec3(0))};
      setEmission(m, factor, base, baseColour.texture);
      warn("unlit: it emits its base colour as radiance and reflects nothing");
    } else {
      m.model = metallicRoughness(baseColour);
      addRelief(m);
      addEmission(m);
    }
    if (from_.occlusionTexture.index >= 0)
      model_.warn("occlusion textures are ignored: light itself tells what is hidden");
    addAlpha(m, base);
    return {builder_.addMaterial(std::move(m)), textures_.uvSet()};
  }

 private:
  void warn(const std::string& text) const { model_.warn("material " + shown_ + ": " + text); }

  MetallicRoughnessModel metallicRoughness(const Colour& baseColour) {
    const auto& pbr = from_.pbrMetallicRoughness;
    const GltfTextureRef both(pbr.metallicRoughnessTexture);
    MetallicRoughnessModel m;
    m.baseColour = baseColour;
    m.metallic = {real(pbr.metallicFactor), textures_.data(both, Channel::Blue)};
    m.roughness = {real(pbr.roughnessFactor), textures_.data(both, Channel::Green)};

    m.ior = {real(gltfNumber(extensionOf(from_, "KHR_materials_ior"), "ior", 1.5))};
    const tinygltf::Value& specular = extensionOf(from_, "KHR_materials_specular");
    const GltfTextureRef weight(specular, "specularTexture"),
        tint(specular, "specularColorTexture");
    m.specular = {real(gltfNumber(specular, "specularFactor", 1.0)), textures_.alpha(weight)};
    m.specularColour = {colourOf(specular, "specularColorFactor"), textures_.colour(tint)};

    const tinygltf::Value& coat = extensionOf(from_, "KHR_materials_clearcoat");
    const GltfTextureRef layer(coat, "clearcoatTexture"), rough(coat, "clearcoatRoughnessTexture");
    m.clearcoat = {real(gltfNumber(coat, "clearcoatFactor", 0.0)),
                   textures_.data(layer, Channel::Red)};
    m.clearcoatRoughness = {real(gltfNumber(coat, "clearcoatRoughnessFactor", 0.0)),
                            textures_.data(rough, Channel::Green)};

    const tinygltf::Value& through = extensionOf(from_, "KHR_materials_transmission");
    const GltfTextureRef share(through, "transmissionTexture");
    m.transmission = {real(gltfNumber(through, "transmissionFactor", 0.0)),
                      textures_.data(share, Channel::Red)};
    return m;
  }

  void addRelief(Material& m) {
    m.relief.normalMap = textures_.normals(GltfTextureRef(from_.normalTexture));
    m.relief.strength = real(from_.normalTexture.scale);
    const tinygltf::Value& coat = extensionOf(from_, "KHR_materials_clearcoat");
    if (!coat.Has("clearcoatNormalTexture")) return;
    m.coatRelief.normalMap = textures_.normals(GltfTextureRef(coat, "clearcoatNormalTexture"));
    m.coatRelief.strength = real(gltfNumber(coat.Get("clearcoatNormalTexture"), "scale", 1.0));
  }

  // Emission is taken as radiance in W/(m2 sr), as Blender exports it.
  void addEmission(Material& m) {
    const double strength =
        gltfNumber(extensionOf(from_, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    const Vec3 colour = colourOf(from_.emissiveFactor) * real(strength);
    if (isBlack(colour)) return;
    const GltfTextureRef image(from_.emissiveTexture);
    setEmission(m, colour, image, textures_.colour(image));
  }
  // Without its texture, the plain colour would shine where the texture is dark.
  void setEmission(Material& m, Vec3 colour, const GltfTextureRef& image, uint32_t expression) {
    const bool lost = image.texture >= 0 && expression == kNone;
    m.emission = lost ? Vec3{} : colour;
    m.emissionTexture = expression;
    if (lost) warn("it does not shine, as the texture of its emission cannot be used");
  }

  void addAlpha(Material& m, const GltfTextureRef& base) {
    const float alpha = real(from_.pbrMetallicRoughness.baseColorFactor[3]);
    if (from_.alphaMode != "OPAQUE" && from_.alphaMode != "MASK" && from_.alphaMode != "BLEND")
      warn("alphaMode '" + onOneLine(from_.alphaMode).substr(0, 60) + "' is unknown; it is opaque");
    if (from_.alphaMode == "MASK") {
      m.opacity = alpha;
      m.opacityCutoff = real(from_.alphaCutoff);
      m.opacityTexture = textures_.alpha(base);
    } else if (from_.alphaMode == "BLEND" && alpha > 0.0f && alpha < 1.0f) {
      addTransparency({alpha, textures_.alpha(base)}, builder_, m);
      fadeEmission(alpha, textures_.alpha(base), m);
      warn(
          "alphaMode BLEND: light goes straight through in proportion to alpha, but not to "
          "shadow rays");
    } else if (from_.alphaMode == "BLEND") {
      m.opacity = alpha;
      m.opacityTexture = textures_.alpha(base);
      if (m.opacityTexture != kNone)
        warn("alphaMode BLEND with a texture's alpha: cut away below 0.5, opaque above");
    }
  }

  // Alpha weights all that a surface sends, its emission included.
  void fadeEmission(float alpha, uint32_t image, Material& m) {
    m.emission *= alpha;
    if (isBlack(m.emission) || image == kNone) return;
    m.emissionTexture = m.emissionTexture == kNone
                            ? image
                            : builder_.addExpression(productExpression(m.emissionTexture, image));
  }

  const GltfModel& model_;
  const tinygltf::Material& from_;
  std::string shown_;
  SceneBuilder& builder_;
  GltfMaterialTextures textures_;
};

std::vector<bool> usedMaterials(const tinygltf::Model& parts) {
  std::vector<bool> used(parts.materials.size() + 1, false);  // the last: primitives without one
  for (const tinygltf::Mesh& mesh : parts.meshes) {
    for (const tinygltf::Primitive& p : mesh.primitives)
      used[p.material < 0 ? parts.materials.size() : static_cast<size_t>(p.material)] = true;
  }
  return used;
}

}  // namespace

std::vector<GltfSurface> addGltfMaterials(const GltfModel& model, SceneBuilder& builder) {
  tinygltf::Material plain;  // the specification's default: rough white metal
  plain.name = "default";
  plain.emissiveFactor = {0, 0, 0};
  const auto& materials = model.parts().materials;
  const std::vector<bool> used = usedMaterials(model.parts());
  std::vector<GltfSurface> out(used.size());
  for (size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const tinygltf::Material& from = i < materials.size() ? materials[i] : plain;
    const std::string shown =
        from.name.empty() ? "#" + gltfPointer("materials", i) : "'" + from.name + "'";
    out[i] = MaterialReader(model, from, shown, builder).add();
  }
  return out;
}

}  // namespace bnvpl
