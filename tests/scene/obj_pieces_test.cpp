// Large OBJ files are read in pieces, side by side, as if they were read in one go.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "scene/read/obj/obj_lines.h"
#include "scene/read/obj/read_obj.h"
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
  for (const MeshLines::Piece& p : lines.pieces) out.push_back(p.material.value_or("none"));
  return out;
}

// Three vertices and the material of each triangle.
std::vector<std::array<int, 4>> facesOf(const ObjReading& reading) {
  std::vector<std::array<int, 4>> out;
  for (const tinyobj::shape_t& shape : reading.shapes) {
    const auto& mesh = shape.mesh;
    for (size_t f = 0; f < mesh.material_ids.size(); ++f) {
      out.push_back({mesh.indices[3 * f].vertex_index, mesh.indices[3 * f + 1].vertex_index,
                     mesh.indices[3 * f + 2].vertex_index, mesh.material_ids[f]});
    }
  }
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
  EXPECT_EQ(startsOf(lines),
            (std::vector<std::string>{"none", "none", "none", "a", "a", "b", "c", "c", ""}));
  EXPECT_EQ(lines.materials, (std::vector<std::string>{"", "a", "c"}));
  EXPECT_EQ(lines.triangles, 4u);
}

TEST_F(Pieces, AreOneWhereTheyNeedEachOther) {
  const std::string plain = "v 0 0 0\nvn 0 0 -1\nf 1 2 3\nf 1/1/1 2/2/2 3/3/3\ng a\nf 1 2 3\n";
  const auto count = [](const std::string& obj) {
    return meshLines("a.obj", obj, 16).pieces.size();
  };
  EXPECT_GT(count("mtllib m\n" + plain), 1u);
  EXPECT_GT(count("mtllib m\nmtllib n\nusemtl a\n" + plain), 1u);
  for (const char* reason : {"f -3 -2 -1\n", "f 4294967295 1 2\n", "f 1 2 3 4\n", "f 1 2\n"})
    EXPECT_EQ(count("mtllib m\n" + plain + reason), 1u) << reason;
  // Libraries are read before, and hold for the whole.
  EXPECT_GT(count("mtllib m\n" + plain + "mtllib late\n"), 1u);
  EXPECT_GT(count("usemtl a\nmtllib m\n" + plain), 1u);
}

TEST_F(Pieces, ErrorsNameTheLineOfTheFile) {
  const std::string before = tower(20'000) + "p 1\n", obj = before + "f 0 1 2\n";
  ASSERT_GT(meshLines("a.obj", obj).pieces.size(), 2u);
  write("square.mtl", kLibrary);
  write("other.mtl", kLibrary);
  write("square.obj", obj);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  for (const char* key : {"", "materials = \"other.mtl\"\n"}) {
    const std::string error = loadError(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n" + key);
    EXPECT_NE(error.find("line " + std::to_string(line) + "."), error.npos) << error;
  }
}

// Small pieces of odd texts against the whole.
TEST_F(Pieces, OddLinesAreReadAsInTheWhole) {
  write("square.mtl", std::string("Kd 1 0 0\n") + kLibrary);  // the first has no name
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 nan\n";
  const std::string texts[] = {
      "v\nvn\nvt\nf\nv nan 0 0\n" + corners + "f 2 3 4\n",
      "mtllib square.mtl\n" + corners + "usemtl odd\nf 1 2 3\nusemtl\nf 1 2 3\nf 2 3 1\nf 3 1 2\n",
      "mtllib square.mtl\n" + corners + "f 4294967295 4294967294 4294967293\n" + corners +
          "f 1 2 3\n",
      "mtllib square.mtl\nmtllib none.mtl\n" + corners +
          "usemtl even\nf 1 2 3\nusemtl nobody\nf 1 2 3\ng a\nf 2 3 1\n",
      corners + "usemtl even\nf 1 2 3\nmtllib square.mtl\nf 1 2 3\nusemtl \\\nodd\nf 2 3 1\n",
  };
  for (const std::string& text : texts) {
    write("square.obj", text);
    const auto none = [](const fs::path&, const tinyobj::material_t&, const MtlKeys&) {};
    const ObjReading whole = readObj(at("square.obj"), {}, none, text.size());
    for (const size_t bytes : {1u, 20u, 40u}) {
      const ObjReading pieces = readObj(at("square.obj"), {}, none, bytes);
      const auto bits = [](const std::vector<double>& v) {
        std::vector<uint64_t> out;
        for (const double x : v) out.push_back(std::isnan(x) ? 1 : std::bit_cast<uint64_t>(x));
        return out;
      };
      EXPECT_EQ(bits(pieces.attrib.vertices), bits(whole.attrib.vertices)) << text;
      EXPECT_EQ(facesOf(pieces), facesOf(whole)) << text;
      EXPECT_EQ(pieces.libraries.missing, whole.libraries.missing) << text;
    }
  }
}

}  // namespace
}  // namespace bnvpl
