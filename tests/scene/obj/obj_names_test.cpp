// Names of materials and libraries as exporters write them: spaces, umlauts, dots, lists, byte
// order marks, continued lines.
#include "scene/read/obj/obj_lines.h"
#include "scene/read/obj/obj_text.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", kFace = "f 1 2 3\n";
const std::string kMark = "\xef\xbb\xbf";

class ObjNames : public SceneFiles {
 protected:
  // A scene with one OBJ file and no library of the fixture.
  Scene loadText(const std::string& obj) const {
    write("m.obj", obj);
    return load(kFilmAndCamera + "[[mesh]]\nfile = \"m.obj\"\n");
  }
  // The red component of each triangle's material, in the order of the faces.
  std::vector<float> reds(const std::string& obj) const {
    const Scene scene = loadText(obj);
    std::vector<float> out;
    for (const Triangle& t : scene.triangles)
      out.push_back(scene.materials[t.material].phong().diffuse.x);
    return out;
  }
  static std::string paint(const std::string& name, const std::string& red) {
    return "newmtl " + name + "\nKd " + red + " 0 0\n";
  }
  // The only warning that contains the part.
  static std::string warning(const Scene& scene, const std::string& part) {
    std::string found;
    for (const std::string& w : scene.warnings) {
      if (w.find(part) == std::string::npos) continue;
      EXPECT_EQ(found, "") << joined(scene.warnings);
      found = w;
    }
    return found;
  }
};
using Reds = std::vector<float>;

TEST_F(ObjNames, MaterialsMayHoldBlanks) {
  write("a.mtl", paint("my left", ".25") + paint("  my right \t", ".5") + paint("my", ".75") +
                     paint("Wände & Türen.001", ".125") + paint("tab\there", ".375"));
  EXPECT_EQ(reds("mtllib a.mtl\n" + kCorners + "usemtl my left\n" + kFace +
                 "usemtl   my right  \n" + kFace + "usemtl my\n" + kFace +
                 "usemtl\tWände & Türen.001\r\n" + kFace + "usemtl tab\there\n" + kFace),
            (Reds{.25f, .5f, .75f, .125f, .375f}));
}

TEST_F(ObjNames, PartOfANameIsNotTheName) {
  write("a.mtl", paint("my", ".25") + paint("my  left", ".5"));
  const Scene scene = loadText("mtllib a.mtl\n" + kCorners + "usemtl my left\n" + kFace);
  EXPECT_EQ(scene.materials.at(scene.triangles.at(0).material).phong().diffuse,
            Vec3(0.5f));  // grey
  EXPECT_EQ(warning(scene, "grey"),
            at("m.obj").string() +
                ": has faces without a known material; they are grey (Kd 0.5): "
                "'my left' is not in " +
                at("a.mtl").string());
}

TEST_F(ObjNames, ACommentBehindANameIsNoneWhereTheNameHoldsIt) {
  write("a.mtl", paint("paint", ".25") + paint("Material #25", ".5"));
  EXPECT_EQ(reds("mtllib a.mtl\n" + kCorners + "usemtl paint # of the wall\n" + kFace +
                 "usemtl Material #25\n" + kFace + "usemtl paint\t#wall\n" + kFace),
            (Reds{.25f, .5f, .25f}));
}

TEST_F(ObjNames, MaterialsKeepTheirNames) {
  write("a.mtl", paint("my left", "1"));
  const Scene scene = loadText("mtllib a.mtl\n" + kCorners + "usemtl my left\n" + kFace);
  EXPECT_EQ(scene.materials.at(0).name, "my left");
}

TEST_F(ObjNames, LibrariesMayHoldBlanks) {
  write("my room.mtl", paint("p", ".25"));
  write("deep in/my room.v2.mtl", paint("p", ".5"));
  const std::string mesh = kCorners + "usemtl p\n" + kFace;
  EXPECT_EQ(reds("mtllib my room.mtl\n" + mesh), (Reds{.25f}));
  EXPECT_EQ(reds("mtllib \t my room.mtl  \r\n" + mesh), (Reds{.25f}));
  EXPECT_EQ(reds("mtllib my\\ room.mtl\n" + mesh), (Reds{.25f}));
  EXPECT_EQ(reds("mtllib deep in\\my room.v2.mtl\n" + mesh), (Reds{.5f}));
  EXPECT_EQ(reds("mtllib ./deep in/my room.v2.mtl\n" + mesh), (Reds{.5f}));
}

TEST_F(ObjNames, ALineMayListLibraries) {
  write("a.mtl", paint("p", ".25") + paint("q", ".25"));
  write("b.mtl", paint("q", ".5") + paint("r", ".5"));
  const std::string mesh =
      kCorners + "usemtl p\n" + kFace + "usemtl q\n" + kFace + "usemtl r\n" + kFace;
  const Reds expected{.25f, .25f, .5f};  // the first library that has the name counts
  EXPECT_EQ(reds("mtllib a.mtl b.mtl\n" + mesh), expected);
  EXPECT_EQ(reds("mtllib  a.mtl \tb.mtl \n" + mesh), expected);
  EXPECT_EQ(reds("mtllib a.mtl\nmtllib b.mtl\n" + mesh), expected);
  EXPECT_EQ(reds("mtllib gone.mtl a.mtl\nmtllib b.mtl a.mtl\n" + mesh), expected);
  EXPECT_EQ(reds("mtllib b.mtl a.mtl\n" + mesh), (Reds{.25f, .5f, .5f}));
  write("a.mtl b.mtl", paint("p", ".75") + paint("q", ".75") + paint("r", ".75"));
  EXPECT_EQ(reds("mtllib a.mtl b.mtl\n" + mesh), (Reds{.75f, .75f, .75f}));
}

TEST_F(ObjNames, LibrariesHoldForTheWholeFile) {
  write("a.mtl", paint("p", ".25"));
  EXPECT_EQ(reds(kCorners + "usemtl p\n" + kFace + "mtllib a.mtl\n" + kFace), (Reds{.25f, .25f}));
}

TEST_F(ObjNames, MissingLibrariesAreNamedAsTheyWereMeant) {
  write("a.mtl", paint("p", "1"));
  const auto missing = [&](const std::string& line) {
    const Scene scene = loadText("mtllib " + line + "\n" + kCorners + "usemtl q\n" + kFace);
    std::string names;
    const std::string problem = ": no such material library";
    for (const std::string& w : scene.warnings) {
      const size_t end = w.find(problem);
      if (end != std::string::npos) names += fs::path(w.substr(0, end)).filename().string() + "|";
    }
    return names;
  };
  EXPECT_EQ(missing("a.mtl"), "");
  EXPECT_EQ(missing("my room.mtl"), "my room.mtl|");
  EXPECT_EQ(missing("b.mtl c.mtl"), "b.mtl|c.mtl|");
  EXPECT_EQ(missing("a.mtl c.mtl"), "c.mtl|");
}

TEST_F(ObjNames, MissingMaterialsAreNamedWithTheLibraries) {
  write("a.mtl", paint("p", "1"));
  write("b.mtl", paint("q", "1"));
  const std::string named = kCorners + "usemtl p\n" + kFace + "usemtl my left\n" + kFace +
                            "usemtl never used\nusemtl Türe.001\n" + kFace;
  const Scene two = loadText("mtllib a.mtl b.mtl\n" + named);
  EXPECT_EQ(warning(two, "known material"),
            at("m.obj").string() +
                ": has faces without a known material; they are grey (Kd 0.5): "
                "'Türe.001', 'my left' are not in " +
                at("a.mtl").string() + ", " + at("b.mtl").string());
  const Scene none = loadText(kCorners + "usemtl p\n" + kFace);
  EXPECT_NE(warning(none, "known material").find("'p' is asked for, but no material library"),
            std::string::npos)
      << joined(none.warnings);
  std::string many = kCorners;
  for (int i = 10; i < 30; ++i) many += "usemtl m" + std::to_string(i) + "\n" + kFace;
  EXPECT_NE(warning(loadText("mtllib a.mtl\n" + many), "known material")
                .find("'m10', 'm11', 'm12', 'm13', 'm14', 'm15' and 14 more are not in "),
            std::string::npos);
  EXPECT_NE(warning(loadText("mtllib a.mtl\n" + kCorners + kFace), "without a material")
                .find("no usemtl"),
            std::string::npos);
}

TEST_F(ObjNames, ByteOrderMarksAreNoPartOfTheFirstWord) {
  write("a.mtl", kMark + paint("p", ".25"));
  EXPECT_EQ(reds(kMark + "mtllib a.mtl\n" + kCorners + "usemtl p\n" + kFace), (Reds{.25f}));
  EXPECT_EQ(reds(kMark + kCorners + "mtllib a.mtl\nusemtl p\n" + kFace), (Reds{.25f}));
}

TEST_F(ObjNames, LinesContinueAfterABackslash) {
  write("a.mtl", "newmtl \\\n p\nKd .25 \\\r\n 0 0\n");
  for (const std::string end : {"\\\n", "\\\r\n", "\\  \n"}) {
    EXPECT_EQ(reds("mtllib " + end + " a.mtl\nv 0 " + end + "0 0\nv 1" + end + "0 0\nv 0 1 0\n" +
                   "usemtl " + end + "p\nf 1 " + end + end + " 2 3\n"),
              (Reds{.25f}))
        << end;
  }
}

TEST(LogicalLines, KeepTheNumbersOfTheOthers) {
  EXPECT_EQ(logicalLines("a\n"), "a\n");
  EXPECT_EQ(logicalLines("a \\\nb\nc\n"), "a  b\n\nc\n");
  EXPECT_EQ(logicalLines("a \\\r\nb\\\r\n c\r\nd"), "a  b  c\r\n\n\nd");
  EXPECT_EQ(logicalLines("a\\\rb\rc\r"), "a b\r\rc\r");
  EXPECT_EQ(logicalLines("a \\"), "a  ");
  EXPECT_EQ(logicalLines("a \\\n"), "a  ");
  EXPECT_EQ(logicalLines("a\\b \\ c\n"), "a\\b \\ c\n");
}

// A path at the end of a comment must not swallow the vertex on the next line.
TEST(LogicalLines, EndWithTheirComments) {
  EXPECT_EQ(logicalLines("# C:\\models\\\nv 1 2 3\n"), "# C:\\models\\\nv 1 2 3\n");
  EXPECT_EQ(logicalLines("a \\\nb # c \\\nd\n"), "a  b # c \\\n\nd\n");
}

TEST_F(ObjNames, ErrorsCountTheLinesOfTheFile) {
  write("m.obj", "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 0 1 2\n");
  const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"m.obj\"\n");
  EXPECT_NE(error.find("m.obj:6: "), std::string::npos) << error;
}

TEST_F(ObjNames, LargeFilesHaveNamesWithBlanksInEachPiece) {
  write("a.mtl", paint("my left", ".25"));
  std::string obj = "mtllib a.mtl\n" + kCorners + "usemtl my left\n";
  while (obj.size() < 3 * kObjPiece) obj += kFace;
  ASSERT_GT(meshLines("m.obj", obj).pieces.size(), 2u);
  for (const float red : reds(obj)) ASSERT_EQ(red, .25f);
}

// tests/scene/blender/make.py wrote this room.
TEST(Blender, RoomIsReadWhole) {
  const fs::path folder = BNVPL_BLENDER_ROOM;
  const fs::path toml =
      fs::temp_directory_path() / ("bnvpl-blender-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(toml) << kFilmAndCamera << "[[mesh]]\nfile = \""
                      << (folder / "my room.obj").string() << "\"\n";
  const Scene scene = loadScene(toml);
  fs::remove(toml);
  EXPECT_EQ(joined(scene.warnings), "");
  ASSERT_EQ(scene.materials.size(), 4u);
  const auto base = [&](const char* name) {
    return std::get<MetallicRoughnessModel>(materialNamed(scene, name).model).baseColour;
  };
  EXPECT_EQ(base("my_left").value, Vec3(.8f, .1f, .1f));
  EXPECT_EQ(base("my.right_2").value, Vec3(.1f, .8f, .1f));
  EXPECT_EQ(materialNamed(scene, "Lampe__weiß.001").emission, Vec3(10));
  const uint32_t map = base("Fußboden_Kachel").texture;
  ASSERT_NE(map, kNone);
  EXPECT_EQ(scene.expressionAt(map, .5f, .5f), Vec3(0, 0, 1));
}

}  // namespace
}  // namespace bnvpl
