// PLY: the columns of an accepted file have equal length, and the scene that refers to it is valid
// for all numbers. Its shape is an area light with a bump map, so that areas, normals and tangents
// are computed. The input is m.ply.
#include "scene/read/pbrt/shapes/ply.h"

#include "fuzz/sane_scene.h"
#include "fuzz/tiny_tga.h"
#include "scene/load_scene.h"

namespace bnvpl {
namespace {

constexpr std::string_view kScene =
    "WorldBegin\n"
    "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"t.tga\"\n"
    "Material \"diffuse\" \"texture displacement\" \"t\"\n"
    "AreaLightSource \"diffuse\" \"float power\" 10\n"
    "Scale 2 -1 1\n"
    "Shape \"plymesh\" \"string filename\" \"m.ply\"\n";

InputFolder makeFolder() {
  InputFolder folder;
  folder.write("t.tga", kTinyTga);
  folder.write("scene.pbrt", kScene);
  return folder;
}

void requireSane(const MeshData& mesh) {
  const size_t n = mesh.vertices();
  require(mesh.positions.size() == 3 * n, "each vertex has three coordinates");
  require(mesh.normals.empty() || mesh.normals.size() == 3 * n,
          "all vertices have normals or none");
  require(mesh.uvs.size() == 2 * n || mesh.uvs.size() == 8, "vertices have uv, or faces four");
  require(mesh.pieces <= mesh.triangles.size(), "each face has a triangle");
  for (const Triangle& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      require(t.position[k] < n, "corners are vertices");
      require(t.normal[k] == kNone || !mesh.normals.empty(), "corners' normals are there");
      require(t.uv[k] == kNone || 2 * size_t{t.uv[k]} < mesh.uvs.size(), "corners' uv are there");
    }
  }
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder = makeFolder();
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const fs::path file = folder.write("m.ply", input);
  if (!accepted([&] { requireSane(pbrt::readPly(file, input)); })) return 0;
  Scene scene;
  if (accepted([&] { scene = loadScene(folder.at("scene.pbrt")); })) requireSane(scene);
  return 0;
}
