// Messages about what a scene names say where it does, what is wrong, and what to do.
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

class Messages : public SceneFiles {
 protected:
  void SetUp() override {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  }
  // Expects an error that names this line of scene.toml, and every part.
  void expectAt(int line, const std::string& toml, const std::vector<std::string>& parts) const {
    const std::string error = loadError(toml);
    const std::string place = "scene.toml:" + std::to_string(line) + ": ";
    EXPECT_NE(error.find(place), std::string::npos) << error;
    for (const std::string& part : parts)
      EXPECT_NE(error.find(part), std::string::npos) << part << " not in: " << error;
  }
  void expectWarning(const Scene& scene, const std::string& part) const {
    EXPECT_EQ(countContaining(scene.warnings, part), 1u) << joined(scene.warnings);
  }
  const std::string mesh_ = "[[mesh]]\nfile = \"square.obj\"\n";
  const std::string base_ = kFilmAndCamera + mesh_;  // 9 lines
};

TEST_F(Messages, AMissingFileIsNamedWithItsLine) {
  expectAt(9, kFilmAndCamera + "[[mesh]]\nfile = ''\n", {"'file' is empty; name a file"});
  for (const std::string name : {"gone.obj", "gone.glb", "gone"}) {
    const std::string what = name == "gone.glb" ? "file" : "OBJ file";
    expectAt(9, kFilmAndCamera + "[[mesh]]\nfile = \"" + name + "\"\n",
             {name + ": no such " + what + "; check its name"});
  }
  expectAt(10, base_ + "materials = \"gone.mtl\"\n", {"gone.mtl: no such MTL file; check"});
  expectAt(12, base_ + "[[light]]\ntype = \"environment\"\nimage = \"gone.exr\"\n",
           {"gone.exr: no such image; check its name"});
  expectWarning(load(base_ + "[[texture]]\nname = \"t\"\ntype = \"image\"\nimage = \"gone.png\"\n"),
                "scene.toml:13: [[texture]]: ");
}

TEST_F(Messages, ASectionThatIsNoTable) {
  expectAt(1, "[[film]]\nwidth = 8\nheight = 6\n" + mesh_,
           {"'film' must be one table; write it as [film]"});
  expectAt(1, "film = 3\n" + mesh_, {"'film' must be one table"});
}

TEST_F(Messages, APointLightNeedsOneOfTwo) {
  expectAt(10, base_ + "[[light]]\ntype = \"point\"\nposition = [0, 0, 1]\n",
           {"needs 'intensity' or 'power'"});
}

TEST_F(Messages, WhatReplacesATextureDependsOnItsUse) {
  const Scene s = loadMesh(kSquareObj,
                           "# a library\nnewmtl paint\nKd 1 1 1\nmap_Kd c.png\nmap_Bump b.png\n"
                           "map_d d.png\n");
  const std::string where = "square.mtl:2: material 'paint': ";
  expectWarning(s, where + at("c.png").string() +
                       ": no such texture; the plain material colour is used");
  expectWarning(s, where + at("b.png").string() + ": no such texture; the surface has no relief");
  expectWarning(s, where + at("d.png").string() + ": no such texture; the surface has no holes");
  write("broken.png", "\x89PNG\r\n\x1a\n");
  const Scene damaged = loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\nmap_Bump broken.png\n");
  expectWarning(damaged, "square.mtl:1: material 'paint': ");
  expectWarning(damaged, "supply a PNG, JPEG, EXR, HDR, PFM, TGA or BMP file; the surface has no relief");
}

TEST_F(Messages, ANormalMapThatCannotBeReadIsNoRelief) {
  write("broken.png", "\x89PNG\r\n\x1a\n");
  const Scene s = loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\nnorm broken.png\n");
  expectWarning(s, "the surface has no relief");
  EXPECT_TRUE(materialNamed(s, "paint").relief.flat());
  const std::string image = "[[texture]]\nname = \"t\"\ntype = \"image\"\nimage = \"gone.png\"\n";
  const Scene product =
      load(base_ + image +
           "[[texture]]\nname = \"p\"\ntype = \"product\"\nfirst = \"t\"\nsecond = \"t\"\n"
           "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\nnormal_map = \"p\"\n");
  EXPECT_TRUE(materialNamed(product, "paint").relief.flat());
}

// No hole, and no mirror for want of a gloss map.
TEST_F(Messages, AnInvertedTextureThatIsMissingLeavesThePlainValue) {
  const Scene s = load(base_ +
                       "[[texture]]\nname = \"t\"\ntype = \"image\"\nimage = \"gone.png\"\n"
                       "factor = [0.5, 0.5, 0.5]\ninvert = true\n"
                       "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\n"
                       "reflectance = [0.3, 0.3, 0.3]\nreflectance_texture = \"t\"\n"
                       "opacity = 0.75\nopacity_texture = \"t\"\n");
  const Material& m = materialNamed(s, "paint");
  EXPECT_EQ(std::get<DiffuseModel>(m.model).reflectance.value, Vec3(0.3f));
  EXPECT_EQ(m.opacity, 0.75f);
}

TEST_F(Messages, AMixThatLosesTheReliefOfAPartSaysSo) {
  write("n.tga", tga(1, 1, {{128, 128, 255, 255}}));
  std::string bare = kSquareObj;
  bare.replace(bare.find("f 1/1"), std::string::npos, "f 1 2 3 4\n");
  write("square.obj", bare);
  const Scene s = load(
      base_ +
      "[[texture]]\nname = \"n\"\ntype = \"image\"\nimage = \"n.tga\"\n"
      "[[material]]\nname = \"rough\"\nmodel = \"diffuse\"\nnormal_map = \"n\"\n"
      "reflectance_texture = \"n\"\n"
      "[[material]]\nname = \"paint\"\nmodel = \"mix\"\nfirst = \"rough\"\nsecond = \"rough\"\n");
  expectWarning(s, "mix 'paint' has no relief, as 'rough' in it has");
  expectWarning(s, "'paint' has a texture but faces without texture coordinates");
}

TEST_F(Messages, AMixOfTooManyLobesSaysSo) {
  const std::string paint = "[[material]]\nname = \"paint\"\nmodel = \"metallic_roughness\"\n",
                    two =
                        "[[material]]\nname = \"two\"\nmodel = \"mix\"\n"
                        "first = \"paint\"\nsecond = \"paint\"\n",
                    more =
                        "[[material]]\nname = \"more\"\nmodel = \"mix\"\n"
                        "first = \"two\"\nsecond = \"paint\"\n";
  const std::string warning = "lobes; where more than 8 have weight, the last are black";
  EXPECT_EQ(countContaining(load(base_ + paint + two).warnings, warning), 0u);
  const Scene s = load(base_ + paint + two + more);
  EXPECT_EQ(countContaining(s.warnings, warning), 1u);
  expectWarning(s, "material 'more' mixes up to 12 " + warning);
}

TEST_F(Messages, AnEmptyListOfInstancesIsNamed) {
  for (const char* file : {"square.obj", "inner.toml"}) {
    write("inner.toml", mesh_);
    const Scene s = load(base_ + "[[mesh]]\nfile = \"" + file + "\"\ninstance = []\n");
    EXPECT_EQ(s.triangles.size(), 2u) << file;
    expectWarning(
        s, "scene.toml:12: [[mesh]]: 'instance' is an empty list, so that the mesh stands nowhere");
  }
}

TEST_F(Messages, OfAnMtlHaveLineAndMaterial) {
  const Scene s =
      loadMesh(kSquareObj, "newmtl paint\nKd nan 1 1\nNs -3\ndisp d.png\nmap_Kd -mm 1 2 c.png\n");
  expectWarning(s, "square.mtl:2: material 'paint': Kd: nan counts as 0");
  expectWarning(s, "square.mtl:3: material 'paint': Ns: -3 is negative and counts as 0");
  expectWarning(s, "square.mtl:1: material 'paint': disp is ignored");
  expectWarning(s, "square.mtl:5: material 'paint': map_Kd: option -mm 1 2 is not supported");
}

TEST_F(Messages, ACommentBehindALibraryIsNone) {
  std::string obj = kSquareObj;
  obj.replace(obj.find("square.mtl"), 10, "square.mtl # lib");
  const Scene s = loadMesh(obj, "newmtl paint\nKd 0.1 0.2 0.3\nKe 1 1 1\n");
  EXPECT_EQ(joined(s.warnings), "");
  EXPECT_EQ(materialNamed(s, "paint").phong().diffuse, Vec3(0.1f, 0.2f, 0.3f));
  obj.replace(obj.find("square.mtl"), 10, "gone.mtl");
  const Scene none = loadMesh(obj, "");
  expectWarning(none, "gone.mtl: no such material library");
  EXPECT_EQ(countContaining(none.warnings, "#"), 0u) << joined(none.warnings);
}

}  // namespace
}  // namespace bnvpl
