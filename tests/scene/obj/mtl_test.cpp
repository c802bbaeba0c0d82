// MTL as Blender and others write it: roughness and metal, normal maps, bump maps.
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

const std::string kBlender = "# Blender 3.4.1 MTL File: 'None'\n# www.blender.org\n\n";
const std::string kPlain =  // Blender's default material as exported
    "newmtl paint\nNs 250.000000\nKa 1.000000 1.000000 1.000000\nKd 0.800000 0.800000 0.800000\n"
    "Ks 0.500000 0.500000 0.500000\nKe 0.000000 0.000000 0.000000\nNi 1.450000\nd 1.000000\n"
    "illum 2\n";

class Mtl : public SceneFiles {
 protected:
  Scene paint(const std::string& mtl) const { return loadMesh(kSquareObj, mtl); }
  static const Material& of(const Scene& s) { return s.materials.at(s.triangles[0].material); }
  static const MetallicRoughnessModel& facets(const Scene& s) {
    return std::get<MetallicRoughnessModel>(of(s).model);
  }
  void writeImage(const std::string& name, std::array<uint8_t, 4> left,
                  std::array<uint8_t, 4> right) const {
    write(name, tga(2, 1, {left, right}));
  }
};

TEST_F(Mtl, BlendersDefaultWallIsNoMirror) {
  const Scene s = paint(kBlender + kPlain);
  const auto& m = facets(s);
  EXPECT_EQ(m.baseColour.value, Vec3(0.8f));
  EXPECT_NEAR(m.roughness.value, 0.5f, 1e-6f);  // from Ns 250
  EXPECT_EQ(m.metallic.value, 0.0f);
  EXPECT_EQ(m.specularColour.value, Vec3(1));  // from Ks 0.5: a reflectance of 0.04
  // Without Blender's header, the same fields give a Phong lobe.
  EXPECT_EQ(of(paint(kPlain)).phong().glossy, Vec3(0.5f));
}

TEST_F(Mtl, BlendersExporterInPythonHasOtherExponents) {
  const Scene s = paint(
      "# Blender MTL File: 'room.blend'\n# Material Count: 1\n\nnewmtl paint\n"
      "Ns 225.000000\nKa 1 1 1\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nillum 2\n");
  EXPECT_NEAR(facets(s).roughness.value, 0.5f, 1e-6f);
}

TEST_F(Mtl, IllumOneHasNoHighlight) {
  const Scene s = paint("newmtl paint\nKd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 30\nillum 1\n");
  EXPECT_EQ(of(s).phong().glossy, Vec3(0));
  EXPECT_EQ(
      facets(paint(kBlender + "newmtl paint\nKd 0.3 0.3 0.3\nKs 0 0 0\nillum 1\n")).specular.value,
      0.0f);
}

TEST_F(Mtl, BlenderSaysMetalByIllumAndKa) {
  const auto m = facets(paint(kBlender + "newmtl paint\nNs 490\nKa 0.5 0.5 0.5\nKd 0.8 0.8 0.8\n"
                                         "Ks 0.5 0.5 0.5\nd 1\nillum 3\n"));
  EXPECT_FLOAT_EQ(m.metallic.value, 0.5f);
  EXPECT_NEAR(m.roughness.value, 0.3f, 1e-6f);
}

TEST_F(Mtl, StatesRoughnessMetalCoatAndScratches) {
  const Scene s = paint(
      "newmtl paint\nKd 0.8 0.4 0.2\nPr 0.3\nPm 1\nPs 0.3\nPc 0.7\nPcr 0.2\naniso 0.5\n"
      "anisor 0.25\n");
  const auto& m = facets(s);
  EXPECT_EQ(m.baseColour.value, Vec3(0.8f, 0.4f, 0.2f));
  EXPECT_FLOAT_EQ(m.roughness.value, 0.3f);
  EXPECT_FLOAT_EQ(m.metallic.value, 1.0f);
  EXPECT_FLOAT_EQ(m.clearcoat.value, 0.7f);
  EXPECT_FLOAT_EQ(m.clearcoatRoughness.value, 0.2f);
  EXPECT_FLOAT_EQ(m.anisotropy.value, 0.5f);
  EXPECT_EQ(countContaining(s.warnings, "Ps (sheen) is ignored"), 1u) << joined(s.warnings);
  EXPECT_FLOAT_EQ(m.anisotropyTurns.value, 0.25f);
}

TEST_F(Mtl, TransmissionIsGlass) {
  const std::string fields = "newmtl paint\nKd 1 1 1\nNi 1.45\nillum 2\nPr 0.2\nTf ";
  const Scene whole = paint(kBlender + fields + "1 1 1\n");
  const auto& glass = std::get<DielectricModel>(of(whole).model);
  EXPECT_FLOAT_EQ(glass.ior.value, 1.45f);
  EXPECT_FLOAT_EQ(glass.roughness.along.value, 0.2f);
  EXPECT_EQ(glass.roughness.alpha, Roughness::Alpha::Square);
  const Scene half = paint(kBlender + fields + "0.5 0.5 0.5\n");
  EXPECT_FLOAT_EQ(std::get<MixModel>(of(half).model).amount.value, 0.5f);
}

// Many programs write Tf 1 1 1 for opaque materials.
TEST_F(Mtl, OfOtherProgramsIlluminationTellsWhatIsGlass) {
  const std::string fields = "newmtl paint\nKd 0.6 0.6 0.6\nNi 1.5\nd 1\nTr 0\nPr 0.5\n";
  const Scene solid = paint(fields + "Tf 1 1 1\nillum 2\n");
  EXPECT_TRUE(std::holds_alternative<MetallicRoughnessModel>(of(solid).model));
  const Scene green = paint(fields + "Tf 0.2 0.9 0.2\nillum 7\n");
  EXPECT_EQ(std::get<DielectricModel>(of(green).model).transmission.value, Vec3(0.2f, 0.9f, 0.2f));
  const Scene clear = paint(fields + "illum 7\n");
  EXPECT_EQ(std::get<DielectricModel>(of(clear).model).transmission.value, Vec3(0.6f));
}

TEST_F(Mtl, OpacityIsAMaskAndSaysSo) {
  for (const auto& [field, text] : {std::pair("d 0.3", "d: below an opacity of 0.5"),
                                    {"d 0.6", "d: from an opacity of 0.5"},
                                    {"d 0", "d: below an opacity of 0.5"},
                                    {"Tr 0.4", "Tr: from an opacity of 0.5"}}) {
    const Scene s = paint("newmtl paint\nKd 0.5 0.5 0.5\n" + std::string(field) + "\n");
    EXPECT_EQ(countContaining(s.warnings, text), 1u) << field << joined(s.warnings);
  }
  for (const char* field : {"d 1", "Tr 0"}) {
    const Scene s = paint("newmtl paint\nKd 0.5 0.5 0.5\n" + std::string(field) + "\n");
    EXPECT_EQ(countContaining(s.warnings, "opacity"), 0u) << field << joined(s.warnings);
  }
}

TEST_F(Mtl, GlassWithoutNiRefracts) {
  const Scene smooth = paint("newmtl paint\nillum 7\n");
  EXPECT_EQ(of(smooth).phong().ior, 1.5f);
  EXPECT_EQ(countContaining(smooth.warnings, "is glass without Ni"), 1u) << joined(smooth.warnings);
  EXPECT_EQ(of(paint("newmtl paint\nNi 1\nillum 7\n")).phong().ior, 1.0f);
  const Scene rough = paint("newmtl paint\nKd 1 1 1\nPr 0.2\nillum 7\n");
  EXPECT_EQ(std::get<DielectricModel>(of(rough).model).ior.value, 1.5f);
}

TEST_F(Mtl, PartlyTransparentIsSeenThrough) {
  const Scene s =
      paint(kBlender + "newmtl paint\nNs 250\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nd 0.4\nillum 9\n");
  const auto& mix = std::get<MixModel>(of(s).model);
  EXPECT_FLOAT_EQ(mix.amount.value, 0.4f);
  EXPECT_TRUE(std::get<DielectricModel>(s.materials[mix.first].model).thin);
  EXPECT_FALSE(of(s).masked());
}

TEST_F(Mtl, TrIsOneMinusD) {
  const Scene s = paint("newmtl paint\nKd 1 1 1\nPr 0.1\nTr 0.8\n");
  ASSERT_TRUE(std::holds_alternative<MixModel>(of(s).model));
  EXPECT_FLOAT_EQ(std::get<MixModel>(of(s).model).amount.value, 0.2f);
  EXPECT_EQ(countContaining(s.warnings, "Tr: light goes straight through"), 1u);
}

// MeshLab wrote Tr 1 for opaque surfaces.
TEST_F(Mtl, TrOneAloneIsOpaqueAndDZeroIsNotThere) {
  for (const std::string metal : {"", "Pr 0.1\n"}) {
    const Scene opaque = paint("newmtl paint\nKd 1 1 1\n" + metal + "Tr 1\n");
    EXPECT_FALSE(of(opaque).masked()) << metal;
    EXPECT_EQ(countContaining(opaque.warnings, "Tr 1 counts as opaque"), 1u) << metal;
    for (const char* gone : {"d 0\n", "d 0\nTr 1\n"}) {
      const Scene none = paint("newmtl paint\nKd 1 1 1\n" + metal + gone);
      EXPECT_TRUE(of(none).masked()) << metal << gone;
      EXPECT_EQ(countContaining(none.warnings, "surface is not there"), 1u) << metal << gone;
    }
  }
}

// tinyobj gives its default factor to the first material alone.
TEST_F(Mtl, AMapWithoutKdHasTheSameFactorInEachMaterial) {
  writeImage("r.tga", {255, 0, 0, 255}, {255, 0, 0, 255});
  const Scene first = paint("newmtl paint\nmap_Kd r.tga\n");
  const Scene second = paint("newmtl other\nKd 0.5 0.5 0.5\nnewmtl paint\nmap_Kd r.tga\n");
  EXPECT_EQ(of(first).phong().diffuse, Vec3(0.6f));
  EXPECT_EQ(of(second).phong().diffuse, Vec3(0.6f));
}

// Blender omits the factor beside a map.
TEST_F(Mtl, MapsReplaceFactorsThatAreNotThere) {
  writeImage("r.tga", {255, 0, 0, 255}, {255, 0, 0, 255});
  writeImage("grey.tga", {51, 51, 51, 255}, {51, 51, 51, 255});
  const Scene s = paint(
      kBlender + "newmtl paint\nNi 1.45\nillum 2\nmap_Kd r.tga\nmap_Ns grey.tga\nmap_Ke r.tga\n");
  const auto& m = facets(s);
  EXPECT_EQ(m.baseColour.value, Vec3(1));
  EXPECT_LT(length(s.expressionAt(m.baseColour.texture, 0.5f, 0.5f) - Vec3(1, 0, 0)), 1e-5f);
  EXPECT_EQ(m.roughness.value, 1.0f);
  EXPECT_NEAR(s.expressionAt(m.roughness.texture, 0.5f, 0.5f).x, 0.2f, 1e-5f);  // linear, not sRGB
  EXPECT_LT(length(s.emissionAt(of(s), 0.5f, 0.5f) - Vec3(1, 0, 0)), 1e-5f);
  const Scene pbr = paint("newmtl paint\nKd 0.5 0.5 0.5\nmap_Pr grey.tga\nmap_Pm grey.tga\n");
  EXPECT_NEAR(pbr.expressionAt(facets(pbr).metallic.texture, 0.5f, 0.5f).x, 0.2f, 1e-5f);
  EXPECT_EQ(facets(pbr).metallic.value, 1.0f);
}

TEST_F(Mtl, EmissionMapScalesKe) {
  writeImage("half.tga", {255, 255, 255, 255}, {0, 0, 0, 255});
  const Scene gone = paint("newmtl paint\nKd 0.5 0.5 0.5\nKe 4 4 4\nmap_Ke gone.tga\n");
  EXPECT_TRUE(isBlack(gone.materials.at(gone.triangles[0].material).emission));
  EXPECT_EQ(countContaining(gone.warnings, "does not shine"), 1u);
  const Scene s = paint("newmtl paint\nKd 0.5 0.5 0.5\nKe 4 4 4\nmap_Ke half.tga\n");
  EXPECT_NEAR(s.emissionAt(of(s), 0.25f, 0.5f).x, 4.0f, 1e-4f);
  EXPECT_NEAR(s.emissionAt(of(s), 0.75f, 0.5f).x, 0.0f, 1e-4f);
}

TEST_F(Mtl, BumpAndNormalMaps) {
  writeImage("n.tga", {255, 128, 128, 255}, {128, 128, 255, 255});
  const Scene bump = paint("newmtl paint\nKd 0.5 0.5 0.5\nmap_Bump -bm 0.5 n.tga\n");
  EXPECT_NE(of(bump).relief.bumpMap, kNone);
  EXPECT_TRUE(of(bump).relief.heightInTexels);
  EXPECT_FLOAT_EQ(of(bump).relief.strength, 0.5f);
  const Scene normal = paint("newmtl paint\nKd 0.5 0.5 0.5\nnorm n.tga\nmap_Bump n.tga\n");
  EXPECT_NE(of(normal).relief.normalMap, kNone);
  EXPECT_EQ(countContaining(normal.warnings, "map_Bump beside norm is ignored"), 1u);
  const Scene blender = paint(kBlender + "newmtl paint\nKd 0.5 0.5 0.5\nmap_Bump -bm 0.7 n.tga\n");
  EXPECT_NE(of(blender).relief.normalMap, kNone);
  EXPECT_FLOAT_EQ(of(blender).relief.strength, 0.7f);
}

TEST_F(Mtl, TheHashKnowsWhatIsNew) {
  const auto hash = [&](const std::string& more) {
    return paint("newmtl paint\nKd 0.5 0.5 0.5\nPr 0.5\n" + more).contentHash;
  };
  EXPECT_EQ(hash(""), hash(""));
  for (const std::string more : {"Pm 0.2\n", "aniso 0.2\n", "anisor 0.2\n", "Pc 0.2\n", "d 0.5\n"})
    EXPECT_NE(hash(""), hash(more)) << more;
}

}  // namespace
}  // namespace bnvpl
