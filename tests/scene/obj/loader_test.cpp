// Oddities of OBJ and MTL files that the loader tolerates, and its messages about them.
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

using Loader = SceneFiles;
const fs::path kScenes = BNVPL_SCENES;

TEST(LoaderQuirks, TriangleCountsAreThoseWithAnArea) {
  const Scene scene = loadScene(kScenes / "test/quirks.toml");
  EXPECT_EQ(scene.triangles.size(), 10u);
  EXPECT_EQ(countContaining(scene.warnings, "quirks.obj: 2 triangles without area"), 1u)
      << joined(scene.warnings);
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) EXPECT_GT(areaOf(scene, t), 0.0);
}

TEST(LoaderQuirks, ConcavePolygonKeepsItsArea) {
  const Scene scene = loadScene(kScenes / "test/quirks.toml");
  EXPECT_NEAR(areaOfMaterial(scene, "Plain"), 1.0 - 0.35, 1e-6);
}

TEST(LoaderQuirks, NegativeIndicesCountFromTheEnd) {
  const Scene scene = loadScene(kScenes / "test/quirks.toml");
  EXPECT_NEAR(areaOfMaterial(scene, "Checker"), 4.0, 1e-6);
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.materials[scene.triangles[t].material].name != "Checker") continue;
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(scene.corner(t, k).y, 0.0f);
    EXPECT_EQ(geometricNormal(scene, t), Vec3(0, 1, 0));
    EXPECT_NE(scene.triangles[t].uv[0], kNone);
  }
}

TEST(LoaderQuirks, EachOddityIsNamedOnce) {
  const Scene scene = loadScene(kScenes / "test/quirks.toml");
  for (const char* part : {"missing.png: no such texture", "without a known material"}) {
    EXPECT_EQ(countContaining(scene.warnings, part), 1u) << part << " in:\n"
                                                         << joined(scene.warnings);
  }
  EXPECT_EQ(countContaining(scene.warnings, "checker.png"), 0u) << joined(scene.warnings);
}

TEST(LoaderQuirks, BackslashPathAndCarriageReturns) {
  const Scene scene = loadScene(kScenes / "test/quirks.toml");
  const uint32_t map = materialNamed(scene, "BackslashPath").phong().diffuseMap;
  ASSERT_NE(map, kNone);
  EXPECT_EQ(map, materialNamed(scene, "Checker").phong().diffuseMap);  // one file, read once
  EXPECT_EQ(materialNamed(scene, "MissingTexture").phong().diffuseMap, kNone);
  EXPECT_EQ(materialNamed(scene, "MissingTexture").phong().diffuse, Vec3(0.4f));
  for (const Material& m : scene.materials) EXPECT_EQ(m.name.find('\r'), std::string::npos);
  std::vector<std::string> files;
  for (const fs::path& f : scene.files) files.push_back(f.filename().string());
  EXPECT_EQ(files, (std::vector<std::string>{"quirks.toml", "quirks.obj", "quirks.mtl",
                                             "checker.png", "missing.png"}));
}

TEST_F(Loader, MissingTextureOfManyMaterialsIsNamedOnce) {
  std::string obj = "mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n", mtl;
  for (const std::string name : {"a", "b", "c"}) {
    obj += "usemtl " + name + "\nf 1/1 2/1 3/1\n";
    mtl += "newmtl " + name + "\nKd 1 1 1\nmap_Kd gone.png\n";
  }
  const Scene scene = loadMesh(obj, mtl);
  EXPECT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(countContaining(scene.warnings, "gone.png"), 1u) << joined(scene.warnings);
}

TEST_F(Loader, DamagedTextureIsAWarningToo) {
  write("bad.png", "not a picture");
  const Scene scene = loadMesh(kSquareObj, "newmtl paint\nKd 0.3 0.3 0.3\nmap_Kd bad.png\n");
  EXPECT_EQ(countContaining(scene.warnings, "bad.png: cannot read the image"), 1u)
      << joined(scene.warnings);
  EXPECT_EQ(scene.materials.at(0).phong().diffuseMap, kNone);
}

// The choice of the diagonal that splits a dart matters: one lies outside it.
TEST_F(Loader, ConcaveQuadKeepsItsArea) {
  const std::string corners =
      "mtllib square.mtl\nv 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\nusemtl paint\n";
  const double area = 0.5;  // two triangles with a common side of 0.5 and a height of 1
  for (const char* face : {"f 1 2 3 4\n", "f 2 3 4 1\n", "f 3 4 1 2\n", "f 4 1 2 3\n"}) {
    const Scene scene = loadMesh(corners + face, "newmtl paint\nKd 1 1 1\n");
    double sum = 0.0;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
      sum += areaOf(scene, t);
      EXPECT_GT(geometricNormal(scene, t).z, 0.99f) << face;
    }
    EXPECT_NEAR(sum, area, 1e-6) << face;
  }
}

TEST_F(Loader, FacesThatNameAbsentVerticesAreLeftOut) {
  const Scene scene = loadMesh(kSquareObj + "f 1 2 99\nf 1 2\n", "newmtl paint\nKd 1 1 1\n");
  EXPECT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(countContaining(scene.warnings, "1 triangles with missing or non-finite vertices"), 1u)
      << joined(scene.warnings);
}

// Such a polygon is left out as a whole, even where most of its corners exist.
TEST_F(Loader, PolygonsThatNameAbsentVerticesAreLeftOutAndCounted) {
  const std::pair<std::string, int> cases[] = {
      {"f 1 2 3 99\n", 2},
      {"f 1 2 3 4 99\n", 3},
      {"f 1/1 2/1 3/1 99/1 4/1 1/1\n", 4},
      {"f 1 2 3 99\nf 4 3 2 99999999999999999999999\nf 1 2 99\n", 5}};
  for (const auto& [faces, lost] : cases) {
    const Scene scene = loadMesh(kSquareObj + faces, "newmtl paint\nKd 1 1 1\n");
    EXPECT_EQ(scene.triangles.size(), 2u) << faces;
    EXPECT_EQ(countContaining(scene.warnings, std::to_string(lost) +
                                                  " triangles with missing or non-finite vertices"),
              1u)
        << faces << joined(scene.warnings);
  }
}

TEST_F(Loader, PolygonsMayNameVerticesThatFollow) {
  const Scene scene =
      loadMesh(kSquareObj + "f 1 2 3 5\ng later\nv 0 0 3\nf 1 2 5\n", "newmtl paint\nKd 1 1 1\n");
  EXPECT_EQ(scene.triangles.size(), 5u);
  EXPECT_EQ(joined(scene.warnings).find("left out"), std::string::npos);
}

TEST_F(Loader, AnObjThatIsNoneIsAnErrorThatNamesIt) {
  write("square.obj", kSquareObj + "f 0 1 2\n");  // indices count from 1
  write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n");
  EXPECT_NE(error.find("square.obj:12: a face names '0'"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST_F(Loader, MissingLibraryMakesThingsGrey) {
  write("square.obj", kSquareObj);
  const Scene scene = load(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n");
  EXPECT_EQ(countContaining(scene.warnings, "square.mtl: no such material library"), 1u)
      << joined(scene.warnings);
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(scene.materials.at(scene.triangles[0].material).phong().diffuse, Vec3(0.5f));
}

TEST_F(Loader, OverrideReplacesTheLibrary) {
  write("other.mtl", "newmtl paint\nKd 0.25 0.5 0.75\n");
  const Scene scene =
      loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\n", "materials = \"other.mtl\"\n");
  EXPECT_EQ(scene.materials.at(0).phong().diffuse, Vec3(0.25f, 0.5f, 0.75f));
  for (const fs::path& f : scene.files) EXPECT_NE(f.filename(), "square.mtl");
}

TEST_F(Loader, MissingObjIsAnErrorThatNamesIt) {
  const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"nowhere.obj\"\n");
  EXPECT_NE(error.find("nowhere.obj: no such OBJ file"), std::string::npos) << error;
}

TEST_F(Loader, EmissionSides) {
  const std::string lamp = "newmtl paint\nKd 0 0 0\nKe 5 6 7\n";
  EXPECT_FALSE(loadMesh(kSquareObj, lamp).materials.at(0).twoSidedEmission);
  EXPECT_EQ(loadMesh(kSquareObj, lamp).materials.at(0).emission, Vec3(5, 6, 7));
  EXPECT_FALSE(loadMesh(kSquareObj, lamp + "emission_sides 1\n").materials.at(0).twoSidedEmission);
  EXPECT_TRUE(loadMesh(kSquareObj, lamp + "emission_sides 2\n").materials.at(0).twoSidedEmission);
  const Scene odd = loadMesh(kSquareObj, lamp + "emission_sides 3\n");
  EXPECT_EQ(countContaining(odd.warnings, "emission_sides"), 1u);
}

TEST_F(Loader, MirrorAndGlassByTheirFields) {
  const auto material = [&](const std::string& fields) {
    return loadMesh(kSquareObj, "newmtl paint\n" + fields).materials.at(0);
  };
  const Material mirror = material("Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n");
  EXPECT_EQ(mirror.phong().mirror, Vec3(0.9f, 0.8f, 0.7f));
  EXPECT_EQ(mirror.phong().glossy, Vec3());
  EXPECT_EQ(material("Kd 0 0 0\nKs 1 1 1\nNs 100000\nillum 2\n").phong().mirror, Vec3(1));
  const Material glossy = material("Kd 0.3 0.3 0.3\nKs 0.2 0.2 0.2\nNs 12\nillum 2\n");
  EXPECT_EQ(glossy.phong().glossy, Vec3(0.2f));
  EXPECT_EQ(glossy.phong().exponent, 12.0f);
  EXPECT_EQ(glossy.phong().mirror, Vec3());
  for (const char* illum : {"4", "6", "7", "9"}) {
    const Material glass =
        material(std::string("Kd 1 1 1\nNi 1.33\nTf 0.5 0.6 0.7\nillum ") + illum + "\n");
    EXPECT_TRUE(glass.phong().glass) << illum;
    EXPECT_FLOAT_EQ(glass.phong().ior, 1.33f);
    EXPECT_EQ(glass.phong().transmission, Vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(glass.phong().diffuse, Vec3());
  }
  // Maya writes its opaque materials so.
  const std::string maya = "Kd 0.5 0.4 0.3\nKa 0 0 0\nTf 1 1 1\nNi 1.00\nillum ";
  for (const char* illum : {"4", "9"}) {
    EXPECT_FALSE(material(maya + illum + "\n").phong().glass) << illum;
    EXPECT_EQ(material(maya + illum + "\n").phong().diffuse, Vec3(0.5f, 0.4f, 0.3f));
    EXPECT_TRUE(std::holds_alternative<MetallicRoughnessModel>(
        material(maya + illum + "\nPr 0.3\n").model));
  }
  EXPECT_TRUE(material(maya + "7\n").phong().glass);
}

// tinyobj would take the next corner's number for what is missing behind a slash.
TEST_F(Loader, SlashesAtTheEndOfACornerNameNothing) {
  const std::string begin =
      "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\n"
      "vt 0 0\nvt 1 0\nvt 0 1\nusemtl paint\n";
  const std::string mtl = "newmtl paint\nKd 0.5 0.5 0.5\n";
  const auto corners = [&](const std::string& face) {
    const Triangle t = loadMesh(begin + face + "\n", mtl).triangles.at(0);
    return std::pair(t.normal, t.uv);
  };
  for (const auto& [face, plain] : {std::pair("f 1/ 2/ 3/", "f 1 2 3"),
                                    {"f 1// 2// 3//", "f 1 2 3"},
                                    {"f 1/1/ 2/2/ 3/3/", "f 1/1 2/2 3/3"},
                                    {"f 1//2 2//1/ 3//3", "f 1//2 2//1 3//3"}})
    EXPECT_EQ(corners(face), corners(plain)) << face;
  EXPECT_NE(corners("f 1/1 2/2 3/3"), corners("f 1 2 3"));
  EXPECT_NE(corners("f 1//1 2//2 3//3"), corners("f 1 2 3"));
}

}  // namespace
}  // namespace bnvpl
