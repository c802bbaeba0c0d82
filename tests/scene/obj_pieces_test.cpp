// Large OBJ files are read in pieces, side by side, as if they were read in one go.
#include <algorithm>

#include "scene/obj_lines.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

using Pieces = SceneFiles;

constexpr const char* kLibrary = "newmtl even\nKd .2 .2 .2\nnewmtl odd\nKd .6 .6 .6\n";

// Triangles above each other, `count` of them, in groups of 1000 that change the material; of every
// 777th, a corner is not a number.
std::string tower(size_t count) {
  std::string obj = "# a tower\nmtllib square.mtl\n";
  for (size_t i = 0; i < count; ++i) {
    if (i % 1000 == 500) obj += i % 2000 == 500 ? "g a\nusemtl even\n" : "o b\r\nusemtl odd\r\n";
    const std::string height = std::to_string(i) + ".25";
    const bool number = i % 777 != 0;
    obj += "v 0 " + height + " 0\nv " + (number ? "1 " : "nan ") + height + " 0\nv 0 " + height +
           " 1 # corner\nvt 0 1\nvn 0 1 0\nl 1 2\n";
    const size_t first = 3 * i + 1;
    obj += "f";
    for (size_t k = 0; k < 3; ++k)
      obj += " " + std::to_string(first + k) + "/" + std::to_string(i + 1) + "/" +
             std::to_string(i + 1);
    obj += "\n";
  }
  return obj;
}

std::vector<std::string> startsOf(const MeshLines& lines) {
  std::vector<std::string> out;
  for (const MeshLines::Piece& p : lines.pieces) out.push_back(p.material);
  return out;
}

TEST_F(Pieces, AreReadAsTheWhole) {
  const std::string obj = tower(20'000);
  ASSERT_GT(meshLines("a.obj", obj).pieces.size(), 2u);
  const Scene pieces = loadMesh(obj, kLibrary);
  // A number that counts back keeps the whole together; its triangle has no area.
  const Scene whole = loadMesh(obj + "f -1 -1 -1\n", kLibrary);
  ASSERT_EQ(meshLines("a.obj", obj + "f -1 -1 -1\n").pieces.size(), 1u);
  ASSERT_EQ(pieces.triangles.size(), 20'000u - 26u);
  ASSERT_EQ(pieces.triangles.size(), whole.triangles.size());
  EXPECT_EQ(pieces.materials.size(), 3u);  // and grey, for the first 500
  for (size_t i = 0; i < pieces.triangles.size(); ++i) {
    const Triangle &a = pieces.triangles[i], &b = whole.triangles[i];
    ASSERT_EQ(a.position, b.position) << i;
    ASSERT_EQ(a.normal, b.normal) << i;
    ASSERT_EQ(a.uv, b.uv) << i;
    ASSERT_EQ(a.material, b.material) << i;
  }
  ASSERT_EQ(pieces.positions.size(), whole.positions.size());
  for (uint32_t i = 0; i < pieces.triangles.size(); ++i)
    ASSERT_EQ(pieces.corner(i, 0), whole.corner(i, 0)) << i;
}

TEST_F(Pieces, StartWithTheMaterialOfThePieceBefore) {
  const MeshLines lines = meshLines(
      "a.obj",
      "mtllib m\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl  b \nusemtl c\r\nf 4 5 6\nusemtl\nf 4 5 6\n",
      1);  // line by line
  EXPECT_EQ(startsOf(lines), (std::vector<std::string>{"", "", "", "a", "a", "b", "c", "c", ""}));
  EXPECT_EQ(lines.materials, (std::vector<std::string>{"", "a", "b", "c"}));
  EXPECT_EQ(lines.triangles, 4u);
}

TEST_F(Pieces, AreOneWhereTheyNeedEachOther) {
  const std::string plain = "v 0 0 0\nvn 0 0 -1\nf 1 2 3\nf 1/1/1 2/2/2 3/3/3\ng a\nf 1 2 3\n";
  const auto count = [](const std::string& obj) {
    return meshLines("a.obj", obj, 16).pieces.size();
  };
  EXPECT_GT(count("mtllib m\n" + plain), 1u);
  EXPECT_GT(count("mtllib m\nmtllib n\nusemtl a\n" + plain), 1u);
  for (const char* reason : {"f -3 -2 -1\n", "f 1 2 3 4\n", "mtllib late\n", "f 1 2\n"})
    EXPECT_EQ(count("mtllib m\n" + plain + reason), 1u) << reason;
  EXPECT_EQ(count("usemtl a\nmtllib m\n" + plain), 1u);
}

TEST_F(Pieces, ErrorsNameTheLineOfTheFile) {
  const std::string obj = tower(10'000), before = obj + "p 1\n";
  write("square.mtl", kLibrary);
  write("square.obj", before + "f 0 1 2\n" + obj);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n");
  EXPECT_NE(error.find("line " + std::to_string(line) + "."), error.npos) << error;
}

}  // namespace
}  // namespace bnvpl
