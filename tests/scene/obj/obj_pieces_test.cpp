// Large OBJ files are read in parallel pieces with the same result as in one go.
#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/read/obj/obj_lines.h"
#include "scene/read/obj/read_obj.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

using Pieces = SceneFiles;

constexpr const char* kLibrary = "newmtl even\nKd .2 .2 .2\nnewmtl odd\nKd .6 .6 .6\n";

// `count` triangles above each other, in groups of 1000 that change the material. Every 777th has a
// corner that is not a number.
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
  for (const MeshLines::Piece& p : lines.pieces) out.push_back(p.material.value_or("none"));
  return out;
}

const auto kIgnore = [](const fs::path&, const tinyobj::material_t&, const MtlKeys&) {};

ObjReading readSquare(const fs::path& obj, size_t pieceBytes = kObjPiece) {
  ObjReading out;
  readObj(obj, {}, kIgnore, out, pieceBytes);
  return out;
}

void expectSame(const ObjReading& pieces, const ObjReading& whole) {
  const auto bits = [](const std::vector<double>& v) {
    std::vector<uint64_t> out;
    for (const double x : v) out.push_back(std::isnan(x) ? 1 : std::bit_cast<uint64_t>(x));
    return out;
  };
  EXPECT_EQ(bits(pieces.mesh.positions), bits(whole.mesh.positions));
  EXPECT_EQ(bits(pieces.mesh.normals), bits(whole.mesh.normals));
  EXPECT_EQ(bits(pieces.mesh.uvs), bits(whole.mesh.uvs));
  EXPECT_EQ(pieces.mesh.corners, whole.mesh.corners);
  EXPECT_EQ(pieces.mesh.counts, whole.mesh.counts);
  EXPECT_EQ(pieces.mesh.materials, whole.mesh.materials);
  EXPECT_EQ(pieces.libraries.missing, whole.libraries.missing);
}

TEST_F(Pieces, AreReadAsTheWhole) {
  const std::string obj = tower(20'000);
  ASSERT_GT(meshLines("a.obj", obj).pieces.size(), 2u);
  const Scene pieces = loadMesh(obj, kLibrary);
  const ObjReading inOneGo = readSquare(at("square.obj"), obj.size());
  ASSERT_EQ(pieces.triangles.size(), 20'000u - 26u);
  EXPECT_EQ(pieces.materials.size(), 3u);  // and grey, for the first 500
  expectSame(readSquare(at("square.obj")), inOneGo);
}

// The text has relative indices and polygons.
TEST_F(Pieces, NeedNothingFromEachOther) {
  std::string obj;
  for (int i = 0; i < 50; ++i)
    obj += "v 0 0 " + std::to_string(i) +
           "\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
           "f -4/-1/-1 -3/-1/-1 -2//-1 -1/-1\n";
  write("square.obj", obj);
  const ObjReading whole = readSquare(at("square.obj"), obj.size());
  ASSERT_EQ(whole.mesh.corners.size(), 200u);
  EXPECT_EQ(whole.mesh.corners[196], (ObjCorner{196, 49, 49}));
  EXPECT_EQ(whole.mesh.corners[198], (ObjCorner{198, 49, kNone}));
  for (const size_t bytes : {1u, 20u, 400u}) expectSame(readSquare(at("square.obj"), bytes), whole);
}

TEST_F(Pieces, StartWithTheMaterialOfThePieceBefore) {
  const MeshLines lines = meshLines(
      "a.obj",
      "mtllib m\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl  b \nusemtl c\r\nf 4 5 6\nusemtl\nf 4 5 6\n",
      1);  // every piece is a line
  EXPECT_EQ(startsOf(lines),
            (std::vector<std::string>{"none", "none", "none", "a", "a", "b", "c", "c", ""}));
  EXPECT_EQ(lines.materials, (std::vector<std::string>{"", "a", "c"}));
  EXPECT_EQ(lines.triangles, 4u);
}

TEST_F(Pieces, ErrorsNameTheLineOfTheFile) {
  const std::string before = tower(20'000) + "p 1\n", obj = before + "f 0 1 2\n";
  ASSERT_GT(meshLines("a.obj", before).pieces.size(), 2u);
  write("square.mtl", kLibrary);
  write("other.mtl", kLibrary);
  write("square.obj", obj);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  for (const char* key : {"", "materials = \"other.mtl\"\n"}) {
    const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n" + key);
    EXPECT_NE(error.find("square.obj:" + std::to_string(line) + ": "), error.npos) << error;
  }
}

// Odd texts in small pieces give the same as the whole.
TEST_F(Pieces, OddLinesAreReadAsInTheWhole) {
  write("square.mtl", std::string("Kd 1 0 0\n") + kLibrary);  // the first material has no name
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 nan\n";
  const std::string texts[] = {
      "f\nv nan 0 0\n" + corners + "f 2 3 4\n",
      "mtllib square.mtl\n" + corners + "usemtl odd\nf 1 2 3\nusemtl\nf 1 2 3\nf 2 3 1\nf 3 1 2\n",
      "mtllib square.mtl\n" + corners + "f 4294967295 4294967294 4294967293\n" + corners +
          "f 1 2 3\n",
      "mtllib square.mtl\n" + corners + "usemtl odd\nf 1 2 3\nusemtl\nf 1 2 3\nf 2 3 1\n",
      "mtllib square.mtl\nmtllib none.mtl\n" + corners +
          "usemtl even\nf 1 2 3\nusemtl nobody\nf 1 2 3\ng a\nf 2 3 1\n",
      corners + "usemtl even\nf 1 2 3\nmtllib square.mtl\nf 1 2 3\nusemtl \\\nodd\nf 2 3 1\n",
  };
  for (const std::string& text : texts) {
    write("square.obj", text);
    const ObjReading whole = readSquare(at("square.obj"), text.size());
    for (const size_t bytes : {1u, 20u, 40u})
      expectSame(readSquare(at("square.obj"), bytes), whole);
  }
}

}  // namespace
}  // namespace bnvpl
