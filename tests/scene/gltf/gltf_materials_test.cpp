#include "tests/scene/gltf/gltf_files.h"

namespace bnvpl {
namespace {

// Red above blue; the lower right corner is half transparent.
const std::string kImage =
    tga(2, 2, {{255, 0, 0, 255}, {255, 0, 0, 255}, {0, 0, 255, 255}, {0, 0, 255, 128}});

class GltfMaterials : public GltfFiles {
 protected:
  // A textured triangle with the material.
  static Gltf withMaterial(const std::string& material) {
    Gltf g = cornerGltf();
    const size_t uvs = g.addAccessor(floats({0, 0, 1, 0, 0, 1}), 3, "VEC2");
    const size_t image = g.addView(kImage);
    g.add("images", "{\"bufferView\":" + std::to_string(image) + ",\"mimeType\":\"image/png\"}");
    g.add("samplers", "{\"wrapS\":33071,\"wrapT\":33648}");
    g.add("textures", "{\"source\":0}");
    g.add("textures", "{\"source\":0,\"sampler\":0}");
    g.add("materials", material);
    g.addMesh("{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":" + std::to_string(uvs) +
              "},\"material\":0}");
    g.show("{\"mesh\":0}");
    return g;
  }
  static const MetallicRoughnessModel& modelOf(const Scene& s, const std::string& name = "a") {
    return std::get<MetallicRoughnessModel>(materialNamed(s, name).model);
  }
  static Vec3 lookUp(const Scene& s, uint32_t expression, float u, float v) {
    return TextureEvaluator(s.expressions, s.textures).at(expression, u, v);
  }
};

TEST_F(GltfMaterials, MetallicRoughnessHasItsFactorsAndTextures) {
  const Scene s = load(withMaterial(
      "{\"name\":\"a\",\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":"
      "[0.5,0.25,1,1],\"metallicFactor\":0.75,\"roughnessFactor\":0.5,\"baseColorTexture\":"
      "{\"index\":0},\"metallicRoughnessTexture\":{\"index\":1}},\"normalTexture\":{\"index\":0,"
      "\"scale\":2},\"occlusionTexture\":{\"index\":0}}"));
  const MetallicRoughnessModel& m = modelOf(s);
  EXPECT_EQ(m.baseColour.value, Vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(m.metallic.value, 0.75f);
  EXPECT_EQ(m.roughness.value, 0.5f);
  EXPECT_EQ(s.textures.size(), 2u);  // colours are decoded from sRGB, data are not
  ASSERT_LT(m.baseColour.texture, s.expressions.size());
  EXPECT_EQ(lookUp(s, m.baseColour.texture, 0.25f, 0.75f), Vec3(1, 0, 0));  // the upper row
  EXPECT_EQ(lookUp(s, m.baseColour.texture, 0.25f, 0.25f), Vec3(0, 0, 1));
  EXPECT_NEAR(lookUp(s, m.metallic.texture, 0.25f, 0.25f).x, 1.0f, 1e-6f);   // blue channel
  EXPECT_NEAR(lookUp(s, m.roughness.texture, 0.25f, 0.25f).x, 0.0f, 1e-6f);  // green channel
  EXPECT_EQ(s.expressions[m.metallic.texture].wrapU, Wrap::Clamp);
  EXPECT_EQ(s.expressions[m.metallic.texture].wrapV, Wrap::Mirror);
  const Material& a = materialNamed(s, "a");
  EXPECT_NE(a.relief.normalMap, kNone);
  EXPECT_EQ(a.relief.strength, 2.0f);
  EXPECT_FALSE(a.masked());
  EXPECT_EQ(countContaining(s.warnings, "occlusion textures are ignored"), 1u);
}

TEST_F(GltfMaterials, TheDefaultIsTheSpecifications) {
  const MetallicRoughnessModel m = modelOf(load(triangleGltf()), "default");
  EXPECT_EQ(m.baseColour.value, Vec3(1));
  EXPECT_EQ(m.metallic.value, 1.0f);
  EXPECT_EQ(m.roughness.value, 1.0f);
}

TEST_F(GltfMaterials, EmissionHasItsStrengthAndSides) {
  const std::string text =
      "{\"name\":\"a\",\"emissiveFactor\":[1,0.5,0],\"emissiveTexture\":{\"index\":0},"
      "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":8}}";
  const Material one = materialNamed(load(withMaterial(text + "}")), "a");
  EXPECT_EQ(one.emission, Vec3(8, 4, 0));
  EXPECT_NE(one.emissionTexture, kNone);
  EXPECT_FALSE(one.twoSidedEmission);
  const Scene two = load(withMaterial(text + ",\"doubleSided\":true}"));
  EXPECT_TRUE(materialNamed(two, "a").twoSidedEmission);
  EXPECT_TRUE(two.hasLight());
}

TEST_F(GltfMaterials, ExtensionsSetTheirParameters) {
  const Scene s = load(withMaterial(
      "{\"name\":\"a\",\"extensions\":{\"KHR_materials_ior\":{\"ior\":2},"
      "\"KHR_materials_transmission\":{\"transmissionFactor\":1,\"transmissionTexture\":{\"index\":"
      "0}},\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5,\"clearcoatRoughnessFactor\":0.25,"
      "\"clearcoatNormalTexture\":{\"index\":1,\"scale\":0.5}},"
      "\"KHR_materials_specular\":{\"specularFactor\":0.125,\"specularColorFactor\":[1,0,1]}}}"));
  const MetallicRoughnessModel& m = modelOf(s);
  EXPECT_EQ(m.ior.value, 2.0f);
  EXPECT_EQ(m.transmission.value, 1.0f);
  EXPECT_NE(m.transmission.texture, kNone);
  EXPECT_EQ(m.clearcoat.value, 0.5f);
  EXPECT_EQ(m.clearcoatRoughness.value, 0.25f);
  const Material& a = materialNamed(s, "a");
  EXPECT_NE(a.coatRelief.normalMap, kNone);
  EXPECT_EQ(a.coatRelief.strength, 0.5f);
  EXPECT_TRUE(a.relief.flat());
  EXPECT_EQ(m.specular.value, 0.125f);
  EXPECT_EQ(m.specularColour.value, Vec3(1, 0, 1));
}

// Rounding, Blender and other exporters produce such numbers.
TEST_F(GltfMaterials, NumbersOutOfRangeAreMovedIntoItWithAWarning) {
  const Scene s = load(withMaterial(
      "{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1.2,0.4,1.0000001192,1],"
      "\"metallicFactor\":-1e-9,\"roughnessFactor\":1.0000001},\"emissiveFactor\":[1.5,0,-1e-7],"
      "\"alphaCutoff\":-0.1,\"extensions\":{\"KHR_materials_transmission\":{"
      "\"transmissionFactor\":1.0000002},\"KHR_materials_emissive_strength\":{"
      "\"emissiveStrength\":-1}}}"));
  const MetallicRoughnessModel& m = modelOf(s);
  EXPECT_EQ(m.baseColour.value, Vec3(1, 0.4f, 1));
  EXPECT_EQ(m.metallic.value, 0.0f);
  EXPECT_EQ(m.roughness.value, 1.0f);
  EXPECT_EQ(m.transmission.value, 1.0f);
  EXPECT_EQ(countContaining(s.warnings,
                            "baseColorFactor/0: is 1.2, outside 0 to 1; 1 is used, also "
                            "at 1 places like it"),
            1u)
      << joined(s.warnings);
  for (const char* name :
       {"metallicFactor: is -1e-09", "roughnessFactor: is 1.0000001", "emissiveFactor/2: is -1e-07",
        "alphaCutoff: is -0.1", "transmissionFactor: is 1.0000002", "emissiveStrength: is -1"})
    EXPECT_EQ(countContaining(s.warnings, name), 1u) << name << joined(s.warnings);
}

TEST_F(GltfMaterials, UnlitEmits) {
  const Scene s = load(withMaterial(
      "{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,0,1]},\"extensions\":{"
      "\"KHR_materials_unlit\":{}}}"));
  EXPECT_EQ(materialNamed(s, "a").emission, Vec3(0.5f, 1, 0));
  EXPECT_TRUE(std::holds_alternative<DiffuseModel>(materialNamed(s, "a").model));
}

TEST_F(GltfMaterials, AlphaModes) {
  const auto load3 = [&](const std::string& mode, const std::string& alpha) {
    return load(withMaterial("{\"name\":\"a\"," + mode +
                             "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1," + alpha +
                             "],\"baseColorTexture\":{\"index\":0}}}"));
  };
  EXPECT_FALSE(materialNamed(load3("", "0.25"), "a").masked());

  const Scene mask = load3("\"alphaMode\":\"MASK\",\"alphaCutoff\":0.75,", "1");
  const Material& m = materialNamed(mask, "a");
  EXPECT_TRUE(m.masked());
  EXPECT_EQ(m.opacityCutoff, 0.75f);
  EXPECT_NEAR(lookUp(mask, m.opacityTexture, 0.75f, 0.25f).x, 128 / 255.0f, 1e-5f);
  EXPECT_NEAR(lookUp(mask, m.opacityTexture, 0.25f, 0.75f).x, 1.0f, 1e-6f);

  const Scene blend = load3("\"alphaMode\":\"BLEND\",", "0.25");
  const Material& b = materialNamed(blend, "a");
  EXPECT_FALSE(b.masked());
  const auto& mix = std::get<MixModel>(b.model);
  EXPECT_EQ(mix.amount.value, 0.25f);
  EXPECT_TRUE(std::get<DielectricModel>(blend.materials.at(mix.first).model).thin);
  EXPECT_EQ(countContaining(blend.warnings, "BLEND"), 1u);

  EXPECT_TRUE(materialNamed(load3("\"alphaMode\":\"BLEND\",", "1"), "a").masked());

  // Emission is composited as reflected light is.
  const Scene lamp = load3("\"alphaMode\":\"BLEND\",\"emissiveFactor\":[1,0.5,0],", "0.25");
  const Material& shining = materialNamed(lamp, "a");
  EXPECT_LT(length(lamp.emissionAt(shining, 0.25f, 0.75f) - Vec3(0.25f, 0.125f, 0)), 1e-5f);
  EXPECT_LT(
      length(lamp.emissionAt(shining, 0.75f, 0.25f) - Vec3(0.25f, 0.125f, 0) * (128 / 255.0f)),
      1e-5f);
}

TEST_F(GltfMaterials, TextureTransformsMoveTurnAndScale) {
  const auto colourAt = [&](const std::string& transform, float u, float v) {
    const Scene s = load(
        withMaterial("{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,"
                     "\"extensions\":{\"KHR_texture_transform\":" +
                     transform + "}}}}"));
    return lookUp(s, modelOf(s).baseColour.texture, u, 1.0f - v);  // v as in the file
  };
  const Vec3 red{1, 0, 0}, blue{0, 0, 1};
  EXPECT_EQ(colourAt("{}", 0.25f, 0.25f), red);
  EXPECT_EQ(colourAt("{\"offset\":[0,0.5]}", 0.25f, 0.25f), blue);
  EXPECT_EQ(colourAt("{\"scale\":[1,3]}", 0.25f, 0.25f), blue);
  // A quarter turn: (u, v) looks up (v, -u), so the file's left is the image's top.
  EXPECT_EQ(colourAt("{\"rotation\":1.5707963267948966}", 0.25f, 0.25f), blue);
  EXPECT_EQ(colourAt("{\"rotation\":1.5707963267948966}", 0.75f, 0.25f), red);
}

TEST_F(GltfMaterials, ImagesComeFromFilesAndDataUris) {
  const std::string material =
      "{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}";
  const auto with = [&](const std::string& uri) {
    std::string text = withMaterial(material).text();
    const std::string embedded = "{\"bufferView\":2,\"mimeType\":\"image/png\"}";
    return text.replace(text.find(embedded), embedded.size(), "{\"uri\":\"" + uri + "\"}");
  };
  write("textures/my image.png", kImage);
  const Scene file = load(with("textures/my%20image.png"));
  EXPECT_EQ(file.textures.size(), 1u);
  EXPECT_EQ(file.files.back(), at("textures/my image.png"));
  EXPECT_EQ(load(with("data:image/png;base64," + base64(kImage))).textures.size(), 1u);

  const Scene gone = load(with("gone.png"));
  EXPECT_EQ(countContaining(gone.warnings, "gone.png: no such texture"), 1u);
  const Scene damaged = load(with("data:image/png;base64,AAAA"));
  EXPECT_EQ(countContaining(damaged.warnings, "#/images/0"), 1u) << joined(damaged.warnings);
  // Images of other types may stand beside those that are read.
  for (const std::string type : {"image/webp", "image/ktx2", "image/png;name=wall"}) {
    const Scene strange = load(with("data:" + type + ";base64,AAAA"));
    EXPECT_EQ(countContaining(strange.warnings, "#/images/0"), 1u) << joined(strange.warnings);
  }
}

TEST_F(GltfMaterials, OneSetOfTextureCoordinatesCounts) {
  Gltf g = withMaterial(
      "{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},"
      "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0,\"texCoord\":1}}");
  const Scene s = load(g);
  EXPECT_EQ(materialNamed(s, "a").emissionTexture, kNone);
  EXPECT_TRUE(isBlack(materialNamed(s, "a").emission));  // the image may be dark nearly everywhere
  EXPECT_EQ(countContaining(s.warnings, "it does not shine"), 1u);
  EXPECT_EQ(countContaining(s.warnings, "uses TEXCOORD_1 beside TEXCOORD_0"), 1u);
}

}  // namespace
}  // namespace bnvpl
