// Materials and textures become models with the parameters of the file.
#include "tests/scene/pbrt/pbrt_files.h"

namespace bnvpl {
namespace {

class PbrtMaterials : public PbrtFiles {
 protected:
  template <typename Model>
  Model model(const std::string& directives) const {
    const Scene s = loadWorld(directives + "\n");
    return std::get<Model>(s.materials.at(s.triangles.at(0).material).model);
  }
  void SetUp() override {
    write("t.tga", tga(2, 1, {{255, 0, 0, 255}, {0, 0, 0, 0}}));
    write("grey.tga", tga(2, 1, {{255, 255, 255, 255}, {0, 0, 0, 255}}));
  }
};

TEST_F(PbrtMaterials, Diffuse) {
  const auto reflectance = [&](const std::string& text) {
    return model<DiffuseModel>(text).reflectance.value;
  };
  EXPECT_EQ(reflectance(""), Vec3{0.5f});
  EXPECT_EQ(reflectance("Material \"diffuse\""), Vec3{0.5f});
  EXPECT_EQ(reflectance("Material \"diffuse\" \"rgb reflectance\" [0.1 0.2 0.3]"),
            Vec3(.1f, .2f, .3f));
  EXPECT_EQ(reflectance("MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"rgb reflectance\" "
                        "[0 1 0]\nNamedMaterial \"m\""),
            Vec3(0, 1, 0));
  const Scene s = loadWorld("NamedMaterial \"none\"\n");
  EXPECT_EQ(countContaining(s.warnings, "no material 'none'"), 1u);
}

TEST_F(PbrtMaterials, Roughness) {
  const auto m = model<CoatedDiffuseModel>(
      "Material \"coateddiffuse\" \"float uroughness\" 0.1 \"float vroughness\" 0.4 "
      "\"bool remaproughness\" false \"float eta\" 1.3 \"float thickness\" 0.1");
  EXPECT_EQ(m.roughness.along.value, 0.1f);
  EXPECT_EQ(m.roughness.across.value, 0.4f);
  EXPECT_EQ(m.roughness.alpha, Roughness::Alpha::Same);
  EXPECT_EQ(m.ior.value, 1.3f);
  EXPECT_EQ(m.thickness.value, 0.1f);
  const auto smooth = model<CoatedDiffuseModel>("Material \"coateddiffuse\"");
  EXPECT_EQ(smooth.roughness.along.value, 0.0f);
  EXPECT_EQ(smooth.roughness.alpha, Roughness::Alpha::Root);
  EXPECT_EQ(smooth.thickness.value, 0.01f);
  const auto fog = loadWorld("Material \"coateddiffuse\" \"rgb albedo\" [1 1 1]\n");
  EXPECT_EQ(countContaining(fog.warnings, "'albedo'"), 1u);
}

TEST_F(PbrtMaterials, Conductors) {
  const auto rgb = model<ConductorModel>(
      "Material \"conductor\" \"rgb eta\" [1.6 0.8 0.5] \"rgb k\" [9 6 4] \"float roughness\" "
      "0.25");
  EXPECT_EQ(rgb.fresnel.eta.value, Vec3(1.6f, 0.8f, 0.5f));
  EXPECT_EQ(rgb.fresnel.k.value, Vec3(9, 6, 4));
  EXPECT_EQ(rgb.roughness.across.value, 0.25f);
  const auto gold = model<ConductorModel>(
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"");
  EXPECT_GT(gold.fresnel.k.value.x, gold.fresnel.k.value.z);
  const auto reflecting =
      model<ConductorModel>("Material \"conductor\" \"rgb reflectance\" [0.9 0.8 0.1]");
  EXPECT_TRUE(reflecting.fresnel.byReflectance);
  EXPECT_EQ(reflecting.fresnel.reflectance.value, Vec3(0.9f, 0.8f, 0.1f));
  const auto coated = model<CoatedConductorModel>(
      "Material \"coatedconductor\" \"float interface.roughness\" 0.01 \"float interface.eta\" 1.4 "
      "\"float conductor.roughness\" 0.2 \"rgb conductor.eta\" [1 1 1] \"rgb conductor.k\" [2 3 "
      "4]");
  EXPECT_EQ(coated.coatIor.value, 1.4f);
  EXPECT_EQ(coated.coatRoughness.along.value, 0.01f);
  EXPECT_EQ(coated.roughness.along.value, 0.2f);
  EXPECT_EQ(coated.fresnel.k.value, Vec3(2, 3, 4));
}

TEST_F(PbrtMaterials, Dielectrics) {
  EXPECT_EQ(model<DielectricModel>("Material \"dielectric\" \"float eta\" 1.33").ior.value, 1.33f);
  EXPECT_EQ(model<DielectricModel>("Material \"dielectric\" \"float eta\" 0.75").ior.value, 0.75f);
  EXPECT_TRUE(model<DielectricModel>("Material \"thindielectric\"").thin);
  const Scene thin = loadWorld("Material \"coateddiffuse\" \"float eta\" 0.8\n");
  EXPECT_EQ(std::get<CoatedDiffuseModel>(thin.materials.back().model).ior.value, 1.0f);
  EXPECT_EQ(countContaining(thin.warnings, "of a coat below 1 counts as 1"), 1u);
  EXPECT_NEAR(
      model<DielectricModel>("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"").ior.value,
      1.5168f, 1e-4f);
  EXPECT_EQ(model<DielectricModel>("Material \"dielectric\" \"spectrum eta\" [500 1.4]").ior.value,
            1.4f);
}

TEST_F(PbrtMaterials, MixesAndWhatIsNotRead) {
  const Scene s = loadWorld(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"conductor\"\n"
      "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 0.3\n");
  const auto& mix = std::get<MixModel>(s.materials.at(s.triangles[0].material).model);
  EXPECT_EQ(mix.amount.value, 0.3f);
  EXPECT_TRUE(std::holds_alternative<DiffuseModel>(s.materials.at(mix.first).model));
  EXPECT_TRUE(std::holds_alternative<ConductorModel>(s.materials.at(mix.second).model));
  write("n.tga", tga(1, 1, {{128, 128, 255, 255}}));
  const Scene bumpy = loadWorld(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"string normalmap\" \"n.tga\"\n"
      "Material \"mix\" \"string materials\" [\"a\" \"a\"]\n");
  EXPECT_EQ(countContaining(bumpy.warnings, "a mix has no relief: that of 'a' is left out"), 1u)
      << joined(bumpy.warnings);
  EXPECT_NE(
      pbrtError("WorldBegin MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" "
                "[\"m\" \"m\"] NamedMaterial \"m\"\n" +
                kSquareShape)
          .find("contains itself"),
      std::string::npos);
  EXPECT_EQ(countContaining(loadWorld("Material \"hair\" \"float beta_m\" 1\n").warnings, "'hair'"),
            1u);
}

TEST_F(PbrtMaterials, ImagesWithTheirMapping) {
  const Scene s = loadWorld(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.tga\" \"float uscale\" 3 "
      "\"float vdelta\" 0.5 \"float scale\" 0.25 \"bool invert\" true \"string wrap\" \"clamp\" "
      "\"string filter\" \"trilinear\"\n"
      "Material \"diffusetransmission\" \"texture reflectance\" \"t\" \"float scale\" 0.5\n");
  const auto& m = std::get<DiffuseTransmissionModel>(s.materials.at(s.triangles[0].material).model);
  EXPECT_EQ(m.reflectance.value, Vec3{0.5f});
  EXPECT_EQ(m.transmittance.value, Vec3{0.125f});
  const TextureExpression& e = s.expressions.at(m.reflectance.texture);
  EXPECT_EQ(e.kind, TextureExpression::Kind::Image);
  EXPECT_EQ(e.uv.a, 3.0f);
  EXPECT_EQ(e.uv.f, 0.5f);
  EXPECT_EQ(e.value, Vec3{0.25f});
  EXPECT_TRUE(e.invert);
  EXPECT_EQ(e.wrapU, Wrap::Clamp);
  EXPECT_TRUE(s.textures.at(e.image).srgb);
  EXPECT_EQ(countContaining(s.warnings, "unknown"), 0u) << joined(s.warnings);
}

// Values of texture graphs at texture coordinates.
TEST_F(PbrtMaterials, Graphs) {
  const auto at = [&](const std::string& textures, float u, float v) {
    const Scene s = loadWorld(textures + "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n");
    const Colour c =
        std::get<DiffuseModel>(s.materials.at(s.triangles[0].material).model).reflectance;
    return c.value * TextureEvaluator(s.expressions, s.textures).at(c.texture, u, v);
  };
  const std::string checks =
      "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 1 0] "
      "\"float uscale\" 4 \"float vscale\" 4";
  expectNear(at(checks, 0.1f, 0.1f), {1, 0, 0}, 1e-5f);
  expectNear(at(checks, 0.3f, 0.1f), {0, 1, 0}, 1e-5f);
  expectNear(at(checks, 0.3f, 0.3f), {1, 0, 0}, 1e-5f);
  const std::string mixed =
      "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [0.2 0.4 0.8]\n"
      "Texture \"f\" \"float\" \"constant\" \"float value\" 0.25\n"
      "Texture \"s\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5\n"
      "Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"s\" \"rgb tex2\" [1 1 1] "
      "\"texture amount\" \"f\"";
  expectNear(at(mixed, 0, 0), Vec3(0.1f, 0.2f, 0.4f) * 0.75f + Vec3{0.25f}, 1e-5f);
}

// Alpha is given as a number, as a constant texture, and as a texture made of a constant one.
TEST_F(PbrtMaterials, ConstantAlphaNeedsNoTextureCoordinates) {
  for (const std::string alpha : {"0", "0.2", "0.5", "0.7", "1"}) {
    const std::string constant = "Texture \"c\" \"float\" \"constant\" \"float value\" " + alpha;
    for (const std::string& by :
         {"Attribute \"shape\" \"float alpha\" " + alpha,
          constant + " Attribute \"shape\" \"texture alpha\" \"c\"",
          constant + " Texture \"s\" \"float\" \"scale\" \"texture tex\" \"c\" \"float scale\" 1 "
                     "Attribute \"shape\" \"texture alpha\" \"s\""}) {
      const Scene s = loadPbrt("WorldBegin\n" + by + "\n" + kSquareShape);
      EXPECT_EQ(s.maskedBegin, std::stod(alpha) < 0.5 ? 0u : 2u) << by;
      const bool partial = alpha.size() > 1;
      EXPECT_EQ(joined(s.warnings).find("from 0.5 on the surface is opaque") != std::string::npos,
                partial)
          << by << joined(s.warnings);
      EXPECT_EQ(joined(s.warnings).find("without texture coordinates"), std::string::npos) << by;
    }
  }
}

TEST_F(PbrtMaterials, ConstantTexturesNeedNoTextureCoordinates) {
  const Scene s = loadPbrt(
      "WorldBegin\nTexture \"c\" \"spectrum\" \"constant\" \"rgb value\" [0.2 0.4 0.6]\n"
      "Material \"diffuse\" \"texture reflectance\" \"c\"\n" +
      kSquareShape);
  const auto& m = std::get<DiffuseModel>(s.materials.at(s.triangles[0].material).model);
  EXPECT_EQ(m.reflectance.texture, kNone);
  expectNear(m.reflectance.value, {0.2f, 0.4f, 0.6f}, 1e-3f);
}

TEST_F(PbrtMaterials, EncodingsAreHeededForPngOnly) {
  const auto decoded = [&](const std::string& encoding) {
    const Scene s =
        loadWorld("Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"t.tga\" " +
                  encoding + "\nMaterial \"diffuse\" \"texture reflectance\" \"a\"\n");
    EXPECT_EQ(countContaining(s.warnings, "heeds it for PNG only"), encoding.empty() ? 0u : 1u);
    return s.textures.at(0).srgb;
  };
  EXPECT_TRUE(decoded(""));
  EXPECT_TRUE(decoded("\"string encoding\" \"linear\""));
}

// A mostly dark image without its file would be a lamp all over.
TEST_F(PbrtMaterials, ImagesOfLampsAreClampedAndNeeded) {
  const auto lamp = [&](const std::string& file) {
    return loadWorld("AreaLightSource \"diffuse\" \"string filename\" \"" + file + "\"\n");
  };
  const Scene screen = lamp("t.tga");
  const Material& m = screen.materials.at(screen.triangles[0].material);
  ASSERT_NE(m.emissionTexture, kNone);
  EXPECT_EQ(screen.expressions.at(m.emissionTexture).wrapU, Wrap::Clamp);
  const Scene gone = lamp("gone.png");
  EXPECT_TRUE(isBlack(gone.materials.at(gone.triangles[0].material).emission));
  EXPECT_EQ(countContaining(gone.warnings, "does not shine"), 1u) << joined(gone.warnings);
}

TEST_F(PbrtMaterials, AlphaCutsAway) {
  const std::string texture =
      "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"t.tga\"\n"
      "Attribute \"shape\" \"texture alpha\" \"a\"\n";
  const Scene s = loadWorld(texture);
  const Material& m = s.materials.at(s.triangles[0].material);
  ASSERT_NE(m.opacityMap, kNone);
  EXPECT_NEAR(m.opacityCutoff, 0.7354f, 1e-4f);  // the code of 0.5, as pbrt decodes alpha, too
  EXPECT_GT(s.textures.at(m.opacityMap).lookupAlpha(0.25f, 0.5f), 0.9f);
  EXPECT_LT(s.textures.at(m.opacityMap).lookupAlpha(0.75f, 0.5f), 0.1f);
  EXPECT_EQ(s.maskedBegin, 0u);
  // A mask that another texture uses, too, is the same image there: its alpha.
  const Scene both = loadWorld(
      "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"t.tga\"\n"
      "Texture \"b\" \"float\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.9\n"
      "AttributeBegin\nAttribute \"shape\" \"texture alpha\" \"a\"\n" +
      kSquareShape + "AttributeEnd\nAttribute \"shape\" \"texture alpha\" \"b\"\n");
  const Material& faded = both.materials.at(both.triangles.back().material);
  ASSERT_NE(faded.opacityTexture, kNone);
  EXPECT_NEAR(both.expressionAt(faded.opacityTexture, 0.25f, 0.5f).x, 0.9f, 0.05f);
  EXPECT_LT(both.expressionAt(faded.opacityTexture, 0.75f, 0.5f).x, 0.1f);
}

TEST_F(PbrtMaterials, Relief) {
  const Scene s = loadWorld(
      "Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"grey.tga\" \"float scale\" 0.1\n"
      "Material \"diffuse\" \"texture displacement\" \"h\"\n");
  EXPECT_NE(s.materials.at(s.triangles[0].material).relief.bumpMap, kNone);
  const Scene n = loadWorld("Material \"diffuse\" \"string normalmap\" \"grey.tga\"\n");
  const Relief& relief = n.materials.at(n.triangles[0].material).relief;
  ASSERT_NE(relief.normalMap, kNone);
  EXPECT_FALSE(n.textures.at(n.expressions.at(relief.normalMap).image).srgb);
}

TEST_F(PbrtMaterials, TexturesDoNotContainThemselves) {
  const Scene loop = loadWorld(
      "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"u\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\n");
  EXPECT_EQ(countContaining(loop.warnings, "no spectrum texture 'u'"), 1u);
  EXPECT_NE(pbrtError("WorldBegin Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\"\n"
                      "Material \"diffuse\" \"texture reflectance\" \"t\"\n" +
                      kSquareShape)
                .find("contains itself"),
            std::string::npos);
}

TEST_F(PbrtMaterials, TexturesOfFloatsAreReadAsTheyAre) {
  const float texels[] = {2.5f, 0.5f, -1.0f};
  write("t.pfm", "PF\n1 1\n-1\n" + std::string(reinterpret_cast<const char*>(texels), 12));
  const Scene s = loadWorld(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\n");
  const auto& m = std::get<DiffuseModel>(s.materials.back().model);
  EXPECT_EQ(s.expressionAt(m.reflectance.texture, 0.3f, 0.7f), Vec3(2.5f, 0.5f, 0));
  EXPECT_EQ(countContaining(s.warnings, "t.pfm: 1 of 1 pixels have negative values"), 1u);
}

// This holds for missing and damaged files, whatever uses the texture.
TEST_F(PbrtMaterials, TexturesThatCannotBeReadAreGrey) {
  write("damaged.png", "no image");
  for (const std::string file : {"gone.exr", "damaged.png"}) {
    const std::string image =
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + file + "\"\n";
    const std::string twice = "Texture \"s\" \"spectrum\" \"scale\" \"texture tex\" \"t\"\n";
    for (const std::string name : {"t", "s"}) {
      const Scene s = loadWorld(image + twice + "Material \"diffuse\" \"texture reflectance\" \"" +
                                name + "\"\n");
      const auto& m = std::get<DiffuseModel>(s.materials.back().model);
      EXPECT_EQ(m.reflectance.value * s.expressionAt(m.reflectance.texture, 0.3f, 0.7f), Vec3(0.5f))
          << file << name;
      EXPECT_EQ(countContaining(s.warnings, file), 1u) << joined(s.warnings);
      EXPECT_EQ(countContaining(s.warnings, "; it is grey"), 1u) << joined(s.warnings);
    }
  }
}

}  // namespace
}  // namespace bnvpl
