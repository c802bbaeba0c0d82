// Directives, transforms, files and mistakes in pbrt files.
#include <zlib.h>

#include "scene/read/pbrt/syntax/lexer.h"
#include "tests/scene/pbrt/pbrt_files.h"
#include "tests/support/world_triangles.h"

namespace bnvpl {
namespace {

class PbrtSyntax : public PbrtFiles {};

TEST(PbrtLexer, TokensAndPlaces) {
  const std::string file = "a.pbrt";
  pbrt::Lexer lexer(file, "# note\nShape \"a\\\"b\"[1 -2e3]\r\n\t+.5#end");
  using Kind = pbrt::Token::Kind;
  const std::pair<Kind, std::string> wanted[]{
      {Kind::Word, "Shape"}, {Kind::String, "a\\\"b"}, {Kind::Open, "["},  {Kind::Word, "1"},
      {Kind::Word, "-2e3"},  {Kind::Close, "]"},       {Kind::Word, "+.5"}};
  pbrt::Token token;
  for (const auto& [kind, text] : wanted) {
    token = lexer.next();
    EXPECT_EQ(token.kind, kind);
    EXPECT_EQ(token.text, text);
  }
  EXPECT_EQ(token.place.text(), "a.pbrt:3:2");
  EXPECT_EQ(lexer.next().kind, Kind::End);
  EXPECT_EQ(pbrt::unescaped("a\\\"b\\\\c\\n"), "a\"b\\c\n");
}

TEST(PbrtLexer, Numbers) {
  double n;
  EXPECT_TRUE(pbrt::toNumber("+1.5e2", n));
  EXPECT_EQ(n, 150.0);
  for (const char* bad : {"", "+", "1x", "nan", "inf", "0x10", "--1"})
    EXPECT_FALSE(pbrt::toNumber(bad, n)) << bad;
}

TEST_F(PbrtSyntax, ErrorsNameThePlaceAndTheCure) {
  expectError("Shape \"sphere", "1:7", {"closing"});
  expectError("WorldBegin\n  Shape \"sphere\" \"float radius\" [1 x]", "2:36", {"number", "'x'"});
  expectError("WorldBegin\nShape \"sphere\" \"float radius\" [1", "2:16", {"'radius'", "]"});
  expectError("WorldBegin\nShape \"sphere\" \"radius\" 1", "2:16", {"a type and a name"});
  expectError("WorldBegin\nShape \"sphere\" \"float radius\" -1", "2:16", {"'radius'", "from 0"});
  expectError("WorldBegin\nShape \"sphere\" \"float radius\" [1 2]", "2:16", {"one number"});
  expectError("WorldBegin\nShape \"sphere\" \"string radius\" \"a\"", "2:16", {"a float"});
  expectError("WorldBegin\nShape \"sphere\" \"float radius\" \"a\"", "2:16", {"numbers"});
  expectError("WorldBegin\nTranslate 1 2", "2:14", {"ends", "number"});
  expectError("WorldBegin\nTranslate 1 2 1e31", "2:15", {"1e30"});
  expectError("WorldBegin\nScale 1 0 1", "2:1", {"Scale"});
  expectError("WorldBegin\nRotate 10 0 0 0", "2:1", {"axis"});
  expectError("LookAt 0 0 0 0 0 0 0 1 0", "1:1", {"LookAt"});
  expectError("Transform [1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1]", "1:1", {"last row"});
  expectError("WorldBegin\n12", "2:1", {"directive", "'12'"});
  expectError("WorldBegin\n]", "2:1", {"directive"});
  expectError("AttributeEnd", "1:1", {"AttributeBegin"});
  expectError("AttributeBegin\n", "2:1", {"scene.pbrt:1:1"});
  expectError("TransformEnd", "1:1", {"AttributeBegin"});
  expectError("ColorSpace \"acescg\"", "1:1", {"acescg", "rec2020"});
  expectError("ObjectBegin \"a\"\nObjectBegin \"b\"", "2:1", {"ObjectEnd"});
  expectError("ObjectBegin \"a\"\nObjectInstance \"a\"", "2:1", {"nests"});
  expectError("ObjectEnd", "1:1", {"ObjectBegin"});
  expectError("WorldBegin\nObjectInstance \"a\"", "2:1", {"no object 'a'"});
  expectError("WorldBegin\nTexture \"t\" \"color\" \"constant\"", "2:1", {"spectrum"});
  expectError("MakeNamedMaterial \"m\"", "1:1", {"'m'", "type"});
  expectError("Attribute \"shapes\" \"float alpha\" 1", "1:1", {"shapes"});
  expectError(
      "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0] "
      "\"integer indices\" [0 1 3]",
      "2:53", {"'indices'", "3 vertices"});
  expectError("WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0]", "2:22", {"multiple of 3"});
  expectError("WorldBegin\nShape \"plymesh\"", "2:1", {"filename"});
}

TEST_F(PbrtSyntax, BlocksOfAThousandLevelsAreTooDeep) {
  std::string text;
  for (int i = 0; i < 1001; ++i) text += "AttributeBegin\n";
  expectError(text, "1001:1", {"1000 blocks"});
}

TEST_F(PbrtSyntax, UnknownThingsAreWarningsByNameAndLine) {
  const Scene scene = loadPbrt(
      "Sampler \"x\" \"float y\" 1\nWobble \"x\" \"float y\" [1 2] 3 true\nWorldBegin\n"
      "Shape \"torus\" \"float r\" 1\nShape \"torus\" \"float r\" 1\n"
      "Shape \"sphere\" \"float colour\" 3\n"
      "LightSource \"laser\"\n");
  const std::string all = joined(scene.warnings);
  for (const char* part : {"scene.pbrt:2:1: directive 'Wobble' is unknown",
                           "scene.pbrt:4:1: shape 'torus' is not read; it is left out (and 1 more)",
                           "scene.pbrt:6:16: Shape \"sphere\": parameter 'colour' is unknown",
                           "scene.pbrt:7:1: light 'laser' is not read"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " not in\n" << all;
  EXPECT_EQ(countContaining(scene.warnings, "Sampler"), 0u);
}

TEST_F(PbrtSyntax, AnOptionHasANameAndOneValue) {
  for (const char* option : {"\"seed\" 0", "\"rendercoordsys\" \"world\"", "\"bool z\" true",
                             "\"disablepixeljitter\" true", "\"string z\" [\"a\"]"}) {
    const Scene scene = loadPbrt("Option " + std::string(option) +
                                 "\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n");
    EXPECT_GT(scene.triangles.size(), 0u) << option;
    EXPECT_TRUE(scene.warnings.empty()) << option << joined(scene.warnings);
  }
  expectError("Option \"seed\"", "1:14", {"needs a value"});
}

TEST_F(PbrtSyntax, ACommentEndsAtACarriageReturn) {
  const Scene two = loadPbrt("WorldBegin\r# a lamp\rShape \"sphere\"\r# more\r\nShape \"disk\"\r");
  const Scene one = loadPbrt("WorldBegin\nShape \"sphere\"\n");
  EXPECT_GT(two.triangles.size(), one.triangles.size());
  expectError("WorldBegin\r\n# a\r\n\r\nShape \"plymesh\"", "4:1", {"filename"});
  expectError("WorldBegin\r# a\r\rShape \"plymesh\"", "4:1", {"filename"});
}

TEST_F(PbrtSyntax, NumbersWithoutLimitAreTaken) {
  const Scene scene = loadPbrt(
      "Film \"rgb\" \"float maxcomponentvalue\" [ 3.402823e38 ]\n"
      "Camera \"perspective\" \"float lensradius\" 0.1 \"float focaldistance\" 1e12\n"
      "WorldBegin\nShape \"sphere\" \"float phimax\" 400\n");
  EXPECT_EQ(countContaining(scene.warnings, "maxcomponentvalue"), 0u) << joined(scene.warnings);
  EXPECT_EQ(countContaining(scene.warnings, "a focus beyond 1e9"), 1u) << joined(scene.warnings);
  EXPECT_EQ(scene.camera.focusDistance, 1e9f);
  const Scene clamped =
      loadPbrt("Film \"rgb\" \"float maxcomponentvalue\" 10\nWorldBegin\nShape \"sphere\"\n");
  EXPECT_EQ(countContaining(clamped.warnings, "scene.pbrt:1:12: "), 1u) << joined(clamped.warnings);
  EXPECT_EQ(countContaining(clamped.warnings, "'maxcomponentvalue' is ignored"), 1u);
}

TEST_F(PbrtSyntax, TransformsApplyInTheirOrder) {
  const Scene scene = loadWorld("AttributeBegin\nTranslate 10 0 0 Rotate 90 0 0 1 Scale 2 1 1\n" +
                                kSquareShape + "AttributeEnd\n");
  // The square, 2 wide and 2 high, becomes 4 wide, is rotated into the y direction and moved.
  expectNear(scene.bounds.lower, {-1, -2, 0}, 1e-5f);
  expectNear(scene.bounds.upper, {11, 2, 0}, 1e-5f);
}

// Rotations about each axis take x to y, y to z and z to x.
TEST_F(PbrtSyntax, RotationsFollowTheRightHandRule) {
  const auto turned = [&](const std::string& axis, const std::string& point) {
    return loadPbrt("WorldBegin Rotate 90 " + axis +
                    " Shape \"trianglemesh\" \"point3 P\" [0 0 0 .01 .02 .03 " + point + "]")
        .bounds.upper;
  };
  expectNear(turned("1 0 0", "0 1 0"), {0.01f, 0.02f, 1}, 0.02f);
  expectNear(turned("0 2 0", "0 0 1"), {1, 0.02f, 0.01f}, 0.03f);
  expectNear(turned("0 0 1", "1 0 0"), {0.02f, 1, 0.03f}, 0.03f);
}

TEST_F(PbrtSyntax, MatricesAreColumnByColumn) {
  const Scene scene = loadPbrt(
      "WorldBegin Translate 1 0 0 ConcatTransform [0 1 0 0 -1 0 0 0 0 0 1 0 5 0 0 1]\n"
      "CoordinateSystem \"here\" Identity CoordSysTransform \"here\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 3 0 0 0 1 0]");
  expectNear(scene.bounds.lower, {5, 0, 0}, 1e-5f);
  expectNear(scene.bounds.upper, {6, 3, 0}, 1e-5f);
}

TEST_F(PbrtSyntax, TheCameraIsACoordinateSystem) {
  const Scene scene = loadPbrt(
      "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\"\nWorldBegin CoordSysTransform "
      "\"camera\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 1 1 0 1 0 1 1]");
  expectNear(scene.bounds.lower, {0, 0, -4}, 1e-5f);
}

TEST_F(PbrtSyntax, ObjectsStandWhereTheirInstancesAre) {
  const Scene scene =
      loadPbrt("WorldBegin Translate 0 0 1 ObjectBegin \"o\" Translate 0 1 0\n" + kSquareShape +
               "ObjectEnd\nObjectInstance \"o\" Translate 5 0 0 ObjectInstance \"o\"");
  EXPECT_EQ(scene.triangles.size(), 2u);  // stored once
  EXPECT_EQ(test::worldTriangles(scene).size(), 4u);
  expectNear(scene.bounds.lower, {-1, 0, 2}, 1e-5f);
  expectNear(scene.bounds.upper, {6, 2, 2}, 1e-5f);
}

// pbrt refuses such area lights, too. One warning names them, however often they are instanced.
TEST_F(PbrtSyntax, LampsInObjectsDoNotEmit) {
  for (const std::string places :
       {"ObjectInstance \"o\"", "ObjectInstance \"o\" Translate 5 0 0 ObjectInstance \"o\""}) {
    const Scene scene = loadPbrt("WorldBegin ObjectBegin \"o\"\nAreaLightSource \"diffuse\"\n" +
                                 kSquareShape + "ObjectEnd\n" + places);
    EXPECT_FALSE(scene.hasLight());
    EXPECT_NE(joined(scene.warnings).find("a lamp within an object does not shine"),
              std::string::npos);
  }
}

TEST_F(PbrtSyntax, AttributesHoldUntilTheirBlockEnds) {
  const Scene scene = loadWorld("AttributeBegin Attribute \"shape\" \"float alpha\" 0\n" +
                                kSquareShape + "AttributeEnd\n");
  EXPECT_EQ(scene.triangles.size(), 4u);
  EXPECT_EQ(scene.maskedBegin, 2u);
}

TEST_F(PbrtSyntax, IncludedFilesAreReadFromTheScenesFolder) {
  write("geometry/all.pbrt", "Translate 0 0 3\n" + kSquareShape + "Include \"more.pbrt\"\n");
  write("more.pbrt", kSquareShape);
  const Scene scene = loadPbrt("WorldBegin\nInclude \"geometry/all.pbrt\"\n" + kSquareShape);
  EXPECT_EQ(scene.triangles.size(), 6u);
  EXPECT_EQ(scene.bounds.lower.z, 3.0f);  // the Include's transform stays
  EXPECT_EQ(scene.files.size(), 3u);
  const Scene imported = loadPbrt("WorldBegin\nImport \"geometry/all.pbrt\"\n" + kSquareShape);
  EXPECT_EQ(imported.bounds.lower.z, 0.0f);
}

TEST_F(PbrtSyntax, IncludesThatGoInCirclesAreRefused) {
  write("a.pbrt", "\nInclude \"b.pbrt\"");
  write("b.pbrt", "Include \"./a.pbrt\"");
  EXPECT_NE(pbrtError("Include \"a.pbrt\"").find("b.pbrt:1:1: "), std::string::npos);
  EXPECT_NE(pbrtError("Include \"a.pbrt\"").find("includes itself"), std::string::npos);
  EXPECT_NE(pbrtError("Include \"none.pbrt\"").find("no such file"), std::string::npos);
}

TEST_F(PbrtSyntax, PackedFiles) {
  const std::string text = "WorldBegin\n" + kSquareShape;
  gzFile packed = gzopen(at("room.pbrt.gz").c_str(), "wb");
  gzwrite(packed, text.data(), static_cast<unsigned>(text.size()));
  gzclose(packed);
  EXPECT_EQ(loadScene(at("room.pbrt.gz")).triangles.size(), 2u);
  fs::resize_file(at("room.pbrt.gz"), fs::file_size(at("room.pbrt.gz")) - 9);
  EXPECT_THROW(loadScene(at("room.pbrt.gz")), InputError);
}

TEST_F(PbrtSyntax, MediaAreNamedAsNotRendered) {
  const Scene scene = loadWorld(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1]\n"
      "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\"\n"
      "Shape \"sphere\" AttributeEnd\n");
  EXPECT_EQ(scene.triangles.size(), 2u);  // an interface is not visible
  EXPECT_EQ(countContaining(scene.warnings, "media are not rendered"), 2u);
}

// pbrt-v4 refuses them as well.
TEST_F(PbrtSyntax, OptionsStandAboveTheWorld) {
  for (const char* option : {"Film \"rgb\"", "Camera \"perspective\"", "Sampler \"halton\"",
                             "Integrator \"path\"", "Accelerator \"bvh\"", "PixelFilter \"box\""}) {
    const std::string name(option, std::string(option).find(' '));
    expectError("WorldBegin\n" + kSquareShape + option, "4:1",
                {name + " stands behind WorldBegin; move it above"});
    EXPECT_EQ(pbrtError(option + ("\nWorldBegin\n" + kSquareShape)), "") << option;
  }
}

TEST_F(PbrtSyntax, AnUnknownFilmIsNamed) {
  const Scene s = loadPbrt("Film \"image\" \"integer xresolution\" 8\nWorldBegin\n" + kSquareShape);
  EXPECT_EQ(countContaining(s.warnings, "scene.pbrt:1:1: film 'image' is unknown"), 1u)
      << joined(s.warnings);
  EXPECT_EQ(s.film.width, 8u);
  for (const char* film : {"rgb", "gbuffer", "spectral"}) {
    const Scene known = loadPbrt("Film \"" + std::string(film) + "\"\nWorldBegin\n" + kSquareShape);
    EXPECT_EQ(countContaining(known.warnings, "film"), 0u) << film;
  }
}

TEST_F(PbrtSyntax, AByteOrderMarkIsSkipped) {
  EXPECT_EQ(pbrtError("\xef\xbb\xbfWorldBegin\n" + kSquareShape), "");
}

TEST_F(PbrtSyntax, AMissingFileIsNamedWithItsPlace) {
  expectError("WorldBegin\nInclude \"gone.pbrt\"", "2:1",
              {"gone.pbrt: no such file; check its name"});
  expectError("WorldBegin\nShape \"plymesh\" \"string filename\" \"gone.ply\"", "2:1",
              {"gone.ply: no such file; check its name"});
  const Scene s = loadWorld(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"gone.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\n");
  EXPECT_EQ(countContaining(s.warnings, "scene.pbrt:2:1: "), 1u) << joined(s.warnings);
}

}  // namespace
}  // namespace bnvpl
