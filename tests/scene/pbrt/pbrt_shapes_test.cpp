// Geometry of shapes, PLY files, and the outside of surfaces.
#include <cstring>
#include <numbers>

#include "scene/read/pbrt/shapes/ply.h"
#include "tests/scene/pbrt/pbrt_files.h"

namespace bnvpl {
namespace {

class PbrtShapes : public PbrtFiles {
 protected:
  Scene shape(const std::string& text) const { return loadPbrt("WorldBegin\n" + text); }
  // The share of the area that faces away from the point.
  static double outward(const Scene& scene, Vec3 from) {
    double sum = 0.0;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
      if (dot(geometricNormal(scene, t), scene.corner(t, 0) - from) > 0) sum += areaOf(scene, t);
    }
    return sum / area(scene);
  }
};

TEST_F(PbrtShapes, SpheresHaveTheirAreaAndFaceOutwards) {
  const Scene scene = shape("Translate 1 2 3 Shape \"sphere\" \"float radius\" 2");
  EXPECT_NEAR(area(scene), 16.0 * std::numbers::pi, 1e-3);
  expectNear(scene.bounds.center(), {1, 2, 3}, 1e-4f);
  EXPECT_NEAR(scene.bounds.extent().x, 4.0, 0.01);
  EXPECT_EQ(outward(scene, {1, 2, 3}), 1.0);
  EXPECT_TRUE(scene.warnings.size() <= 1u) << joined(scene.warnings);  // about light
}

TEST_F(PbrtShapes, PartsOfSpheres) {
  const Scene cap = shape("Shape \"sphere\" \"float zmin\" 0.5");
  EXPECT_NEAR(area(cap), std::numbers::pi, 1e-4);
  const Scene half = shape("Shape \"sphere\" \"float phimax\" 180");
  EXPECT_NEAR(area(half), 2.0 * std::numbers::pi, 1e-4);
  EXPECT_GE(half.bounds.lower.y, -1e-6f);
}

TEST_F(PbrtShapes, MirrorsAndReverseOrientationTurnTheOutside) {
  const std::string sphere = "Shape \"sphere\"";
  EXPECT_EQ(outward(shape("Scale -1 1 1 " + sphere), {}), 1.0);
  EXPECT_EQ(outward(shape("ReverseOrientation " + sphere), {}), 0.0);
  EXPECT_EQ(outward(shape("Scale -1 1 1 ReverseOrientation " + sphere), {}), 0.0);
}

// pbrt-v4, Triangle and BilinearPatch: (0, 0), (1, 0), (1, 1) of triangles, and (0, 1) of quads.
TEST_F(PbrtShapes, MeshesWithoutTextureCoordinatesHaveThoseOfTheirFaces) {
  const auto expectUvs = [&](const std::string& text,
                             const std::vector<std::array<float, 2>>& all) {
    const Scene s = shape(text);
    std::vector<std::array<float, 2>> found;
    for (const Triangle& t : s.triangles)
      for (const uint32_t uv : t.uv) found.push_back(s.uvs.at(uv));
    EXPECT_EQ(found, all) << text;
  };
  const std::array<float, 2> a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1};
  const std::string points = " \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]";
  expectUvs("Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]" + points,
            {a, b, c, a, b, c});
  write("quad.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n4 0 1 2 3\n");
  expectUvs("Shape \"plymesh\" \"string filename\" \"quad.ply\"", {a, b, c, a, c, d});
}

TEST_F(PbrtShapes, DisksAndCylinders) {
  const Scene ring = shape(
      "Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1 "
      "\"float height\" 3");
  EXPECT_NEAR(area(ring), 3.0 * std::numbers::pi, 1e-4);
  EXPECT_EQ(ring.bounds.lower.z, 3.0f);
  EXPECT_NEAR(geometricNormal(ring, 0).z, 1.0, 1e-6);
  const Scene tube =
      shape("Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 0 \"float zmax\" 5");
  EXPECT_NEAR(area(tube), 20.0 * std::numbers::pi, 1e-3);
  EXPECT_EQ(outward(tube, {0, 0, 2.5f}), 1.0);
}

TEST_F(PbrtShapes, NormalsOfAMeshSayWhatIsOutside) {
  const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";
  EXPECT_NEAR(geometricNormal(shape(mesh), 0).z, 1.0, 1e-6);
  EXPECT_NEAR(geometricNormal(shape(mesh + "\"normal N\" [0 0 -1 0 0 -1 0 0 -1]"), 0).z, -1.0,
              1e-6);
}

TEST_F(PbrtShapes, BilinearPatches) {
  const std::string flat = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 3 0 2 3 0]";
  const Scene scene = shape(flat);
  EXPECT_EQ(scene.triangles.size(), 2u);
  EXPECT_NEAR(area(scene), 6.0, 1e-6);
  EXPECT_NEAR(geometricNormal(scene, 0).z, 1.0, 1e-6);
  // On z = u v over the unit square, the integral of sqrt(1 + u^2 + v^2) is 1.2808.
  const Scene bent = shape("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]");
  EXPECT_EQ(bent.triangles.size(), 512u);
  EXPECT_NEAR(area(bent), 1.2808, 1e-3);
  EXPECT_EQ(countContaining(bent.warnings, "512 triangles"), 1u);
}

// An octahedron approaches a sphere: the limit of every vertex of valence 4 lies on its axis.
TEST_F(PbrtShapes, LoopSubdivision) {
  const std::string octahedron =
      "Shape \"loopsubdiv\" \"integer levels\" [4] \"point3 P\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 "
      "0 -1]"
      " \"integer indices\" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]";
  const Scene scene = shape(octahedron);
  EXPECT_EQ(scene.triangles.size(), 8u * 256u);
  EXPECT_EQ(outward(scene, {}), 0.0);  // as in pbrt, its normals are against the winding
  EXPECT_EQ(outward(shape("ReverseOrientation " + octahedron), {}), 1.0);
  expectNear(scene.bounds.center(), {}, 1e-6f);
  // The limit of a vertex has the weight 1 - 4 g for itself, and its neighbours cancel; g = 1 / (4
  // + 3 / (8 b)), b = 3/32.
  EXPECT_NEAR(scene.bounds.upper.x, 1.0 - 4.0 / 8.0, 1e-5);
  float least = 1.0f;
  for (const Vec3& p : scene.positions) {
    if (!isBlack(p)) least = std::min(least, length(p));
  }
  EXPECT_GT(least, 0.4f);
}

std::string bytesOf(float value, bool big = false) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  return big ? std::string(raw.rbegin(), raw.rend()) : raw;
}

std::string plySquare(const std::string& format) {
  const std::string header = "ply\nformat " + format +
                             " 1.0\ncomment a square\nelement vertex 4\nproperty float x\n"
                             "property float y\nproperty uchar tag\nproperty float z\n"
                             "element face 1\nproperty list uchar int vertex_indices\n"
                             "property uchar more\nend_header\n";
  if (format == "ascii") return header + "0 0 7 1\n2 0 7 1\n2 1 7 1\n0 1 7 1\n4 0 1 2 3 9\n";
  const bool big = format == "binary_big_endian";
  std::string body;
  for (const auto& [x, y] : {std::pair{0.f, 0.f}, {2.f, 0.f}, {2.f, 1.f}, {0.f, 1.f}})
    body += bytesOf(x, big) + bytesOf(y, big) + '\7' + bytesOf(1.0f, big);
  body += '\4';
  for (char i = 0; i < 4; ++i) {
    const std::string index{i, 0, 0, 0};
    body += big ? std::string(index.rbegin(), index.rend()) : index;
  }
  return header + body + '\11';
}

TEST(Ply, EveryFormat) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const MeshData mesh = pbrt::readPly("a.ply", plySquare(format));
    const std::vector<double> wanted{0, 0, 1, 2, 0, 1, 2, 1, 1, 0, 1, 1};
    EXPECT_EQ(mesh.positions, wanted) << format;
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[1].position, (std::array<uint32_t, 3>{0, 2, 3}));
    EXPECT_EQ(mesh.pieces, 1u);
    EXPECT_TRUE(mesh.normals.empty());
  }
}

// In text, the last blank is not needed.
TEST(Ply, EveryPrefixIsRefused) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string whole = plySquare(format);
    const size_t end = whole.size() - (std::string(format) == "ascii" ? 2 : 1);
    for (size_t size = 0; size <= end; ++size)
      EXPECT_THROW(pbrt::readPly("a.ply", whole.substr(0, size)), InputError) << format << size;
  }
}

TEST(Ply, ClaimsAreCheckedBeforeAnythingIsAllocated) {
  const std::string vertices =
      "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n0 0 0\n";
  EXPECT_THROW(pbrt::readPly("a.ply", vertices), InputError);
  std::string outside = plySquare("ascii");
  outside.replace(outside.find("4 0 1 2 3"), 9, "4 0 1 2 4");
  EXPECT_THROW(pbrt::readPly("a.ply", outside), InputError);
}

// A count in text can be any number and is bounded before it is used as a size.
TEST(Ply, ListsWithoutEndAreCutShort) {
  for (const char* count : {"inf", "1e300", "18446744073709551616"}) {
    for (const char* list : {"vertex_indices", "other"}) {
      const std::string bytes =
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
          "property float z\nelement face 1\nproperty list uchar int " +
          std::string(list) + "\nend_header\n0 0 0\n" + count + " 0 0 0\n";
      EXPECT_THROW(pbrt::readPly("a.ply", bytes), InputError) << list << " " << count;
    }
  }
}

// An image without the mesh would look as if it had been asked for.
TEST(Ply, AMeshWithoutFacesIsNoted) {
  const std::string
      vertices =
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
          "property float z\n",
      corners = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string list = "property list uchar int ";
  const std::map<std::string, std::string> bodies{
      {"", ""},
      {"element face 0\n" + list + "vertex_indices\n", ""},
      {"element tristrips 1\n" + list + "vertex_indices\n", "3 0 1 2\n"},
      {"element face 1\n" + list + "corners\n", "3 0 1 2\n"}};
  for (const auto& [header, body] : bodies) {
    const MeshData mesh = pbrt::readPly("a.ply", vertices + header + corners + body);
    ASSERT_EQ(mesh.notes.size(), 1u) << header;
    EXPECT_EQ(mesh.notes[0].find("a.ply: has no faces; it adds nothing"), 0u) << mesh.notes[0];
    const bool unread = !body.empty();
    EXPECT_EQ(mesh.notes[0].find("is not read; export") != std::string::npos, unread) << header;
  }
  const std::string both = "element face 1\n" + list + "vertex_indices\nelement tristrips 1\n" +
                           list + "vertex_indices\n";
  const MeshData mesh = pbrt::readPly("a.ply", vertices + both + corners + "3 0 1 2\n3 0 1 2\n");
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("'vertex_indices' of element 'tristrips' is not read"),
            std::string::npos);
  EXPECT_TRUE(pbrt::readPly("a.ply", plySquare("ascii")).notes.empty());
}

TEST_F(PbrtShapes, PlyMeshes) {
  write("models/a.ply", plySquare("ascii"));
  const Scene scene = shape("Shape \"plymesh\" \"string filename\" [ \"models/a.ply\" ]");
  EXPECT_NEAR(area(scene), 2.0, 1e-6);
  EXPECT_EQ(scene.files.back(), at("models/a.ply"));
  const std::string error = pbrtError("WorldBegin Shape \"plymesh\" \"string filename\" \"b.ply\"");
  EXPECT_NE(error.find("b.ply: no such file"), std::string::npos) << error;
}

TEST(Ply, MistakesInTheHeaderHaveTheirLine) {
  const std::string start = "ply\nformat ascii 1.0\nelement vertex 3\n";
  const std::map<std::string, std::string> mistakes{
      {"property flaot x\n", "a.ply:4: the type 'flaot' is unknown; export the mesh again"},
      {"element face many\n", "a.ply:4: 'many' is no number of 'face'"},
      {"colour red\n", "a.ply:4: the header has the unknown line 'colour'"}};
  for (const auto& [line, wanted] : mistakes) {
    try {
      pbrt::readPly("a.ply", start + line + "end_header\n");
      FAIL() << line;
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find(wanted), 0u) << e.what();
    }
  }
}

}  // namespace
}  // namespace bnvpl
