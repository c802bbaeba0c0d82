// Malicious files: those that fuzzing found, and those that it looks for. See fuzz/README.md.
#include <sys/stat.h>

#include "scene/read/obj/load_obj.h"
#include "scene/read/obj/obj_lines.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

class Hostile : public SceneFiles {
 protected:
  void expectError(const std::string& toml, const std::string& part) const {
    const std::string error = loadError(toml);
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
  // A scene with the square and `more` lines.
  std::string scene(const std::string& more) const {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 0.5 0.5 0.5\n");
    return kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n" + more;
  }
};

EnvironmentImage environmentOf(const fs::path& file) {
  size_t negative = 0;
  return loadEnvironment(file, negative);
}

std::string repeated(const std::string& text, size_t times) {
  std::string all;
  for (size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST_F(Hostile, DirectionsOfAnyLengthBecomeUnitVectors) {
  const std::string sun = "[[light]]\ntype = \"directional\"\nirradiance = [1, 1, 1]\ndirection = ";
  for (const char* direction : {"[0, 1e30, -1e30]", "[0, 1e-40, -1e-40]", "[0, 7, -7]"}) {
    const Vec3 d = load(scene(sun + direction + "\n")).lights.at(0).direction;
    EXPECT_NEAR(d.y, std::sqrt(0.5f), 1e-6f) << direction;
    EXPECT_NEAR(d.z, -std::sqrt(0.5f), 1e-6f) << direction;
  }
}

TEST_F(Hostile, NormalsOfAnyLengthBecomeUnitVectorsAndNoneWithoutADirection) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1//1 2//1 3//1\n";
  const Scene s = loadMesh(triangle + "vn 3e38 3e38 3e38\n" + face, "", "scale = 1e3\n");
  EXPECT_NEAR(s.normals.at(s.triangles.at(0).normal[0]).x, std::sqrt(1.0f / 3.0f), 1e-6f);
  for (const char* none : {"vn 0 0 0\n", "vn nan 0 0\n", "vn 1e400 0 0\n"}) {
    EXPECT_EQ(loadMesh(triangle + none + face, "").triangles.at(0).normal[0], kNone) << none;
  }
}

TEST_F(Hostile, DeepKeysAreRefused) {
  expectError("a" + repeated(".a", 1'000'000) + " = 1\n", "scene.toml:1: more than 100 dots");
}

TEST_F(Hostile, WhatIsNoRegularFileIsRefusedAndNeverOpened) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);  // opening it would block for ever
  const std::string sky = "[[light]]\ntype = \"environment\"\nimage = ";
  for (const std::string name : {"pipe", ".", "/dev/zero"}) {
    expectError(scene(sky + "\"" + name + "\"\n"), "no such image");
    expectError(kFilmAndCamera + "[[mesh]]\nfile = \"" + name + "\"\n", "no such OBJ file");
    EXPECT_THROW(loadScene(at(name)), InputError);
    const Scene s = loadMesh("mtllib " + name + "\n" + kSquareObj, "newmtl paint\nmap_Kd " + name);
    EXPECT_EQ(countContaining(s.warnings, "no such material library"), 1u) << joined(s.warnings);
    EXPECT_EQ(countContaining(s.warnings, "no such texture"), 1u) << joined(s.warnings);
  }
  const std::string longName(5000, 'n');
  expectError(scene(sky + "\"" + longName + "\"\n"), "no such image");
  EXPECT_NO_THROW(loadMesh(kSquareObj, "newmtl paint\nmap_Kd " + longName));
}

TEST_F(Hostile, PolygonsThatTakeForEverToCutAreRefused) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf" + repeated(" 1 2 3", 400) + "\n";
  write("square.obj", corners);
  const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n");
  EXPECT_NE(error.find("square.obj:4: a face of more than 1024 corners"), std::string::npos)
      << error;
}

// tinyobj stores lines, points and tags of every shape again for each later shape.
TEST_F(Hostile, WhatIsNoMeshIsLeftOut) {
  const std::string waste = "l 1 2\np 3\nt a 9000/9000/9000\nvw 0 1e99 nan\nusemtl x\nusemtl y\n";
  const Scene s = loadMesh(repeated("l 1 0\rp 0\r\n", 3) + kSquareObj + repeated(waste, 2'000),
                           "newmtl paint\nKd 1 1 1\n");
  EXPECT_EQ(s.triangles.size(), 2u);
  EXPECT_EQ(meshLines("a.obj", waste).text,
            "# 1 2\n# 3\n# a 9000/9000/9000\n#w 0 1e99 nan\nusemtl x\nusemtl y\n");
}

TEST_F(Hostile, ALibraryIsReadOnce) {
  std::string obj;
  for (size_t i = 0; i < 100; ++i) obj += "mtllib " + repeated("./", i) + "square.mtl\n";
  const Scene s = loadMesh(obj + kSquareObj, "newmtl paint\n" + repeated("newmtl other\n", 1'000));
  EXPECT_EQ(s.triangles.size(), 2u);
  EXPECT_EQ(s.files.size(), 3u);  // scene, mesh, and one library under a hundred names
}

TEST_F(Hostile, EndlessScalesOfTexturesAreHarmless) {
  write("t.tga", tga(1, 1, {{255, 255, 255, 255}}));
  for (const char* scale : {"1e99 1", "1 -1e38", "1e2147483649 1"}) {
    const Scene s = loadMesh(
        kSquareObj, "newmtl paint\nmap_Kd -s " + std::string(scale) + " 1 -o 3e38 1 1 t.tga\n");
    for (const float uv : {0.0f, 1.0f, 1e38f, -1e38f}) {
      s.textures.at(0).lookup(uv, uv);  // must stay inside the image
      s.textures.at(0).lookupAlpha(uv, uv);
    }
  }
}

TEST_F(Hostile, ImagesThatClaimTooMuchAreRefused) {
  std::string claims = tga(1, 1, {{1, 2, 3, 4}});
  claims[13] = claims[15] = 0x7f;  // 32513 x 32512 texels, 4 GiB of them
  claims[2] = 10;                  // run-length encoded: the size of the file says nothing
  write("t.tga", claims);
  EXPECT_THROW(loadTexture(at("t.tga"), true, false), InputError);
  EXPECT_THROW(environmentOf(at("t.tga")), InputError);
}

TEST_F(Hostile, ChunksThatClaimTooMuchAreRefused) {
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x04\0\0\0\x04\x08\2\0\0\0", 29);
  png += std::string("\0\0\0\0\x3f\xff\xff\xffIDAT", 12);  // claims that 1 GiB follows
  write("t.png", png);
  EXPECT_THROW(loadTexture(at("t.png"), true, false), InputError);
}

TEST_F(Hostile, RadianceImagesThatAreCutShortAreRefused) {
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n";
  const std::string row("\2\2\0\x08\x88\x80\x88\x40\x08\1\2\3\4\5\6\7\x08\x88\x81", 19);
  write("a.hdr", header + row + row);
  const EnvironmentImage e = environmentOf(at("a.hdr"));
  ASSERT_EQ(e.radiance.size(), 16u);
  EXPECT_EQ(e.radiance[10], Vec3(1.0f, 0.5f, 3.0f / 128.0f));
  const std::string flat(2 * 8 * 4, '\x80');
  write("flat.hdr", header + flat);
  EXPECT_EQ(environmentOf(at("flat.hdr")).radiance.at(15), Vec3(0.5f));
  for (const std::string& whole : {header + row + row, header + flat}) {
    for (size_t length = 0; length < whole.size(); ++length) {
      write("a.hdr", whole.substr(0, length));
      EXPECT_THROW(environmentOf(at("a.hdr")), InputError) << length;
    }
  }
}

}  // namespace
}  // namespace bnvpl
