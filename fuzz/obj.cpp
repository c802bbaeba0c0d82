// OBJ and MTL: an accepted file makes valid triangles, materials and textures.
//
// The input is an OBJ; from a line "# MTL" on it is m.mtl and "my m.mtl", to which the OBJ can
// refer. Their folder also has t.tga. The OBJ is loaded as it is, and mirrored with m.mtl in place
// of its libraries. Reading it in small pieces must give the same result.
#include "fuzz/sane_scene.h"
#include "fuzz/tiny_tga.h"
#include "scene/read/obj/load_obj.h"
#include "scene/read/obj/read_obj.h"

namespace bnvpl {
namespace {

constexpr std::string_view kMtl = "# MTL\n";

InputFolder makeFolder() {
  InputFolder folder;
  folder.write("t.tga", kTinyTga);
  return folder;
}

void load(const fs::path& obj, const fs::path& materials, const Affine& transform) {
  Scene scene;
  const auto read = [&] {
    SceneBuilder builder("fuzz");
    loadObj(obj, materials, transform, builder);
    scene = builder.finish();
  };
  if (accepted(read)) requireSaneMeshes(scene);
}

// Reads the file in pieces, as large files are read, and as a whole.
void requireSameInPieces(const fs::path& obj, const fs::path& materials) {
  ObjReading whole, pieces;
  const auto ignore = [](const fs::path&, const tinyobj::material_t&, const MtlKeys&) {};
  constexpr size_t kPiece = 16, kAll = size_t{1} << 30;
  const bool asWhole = accepted([&] { readObj(obj, materials, ignore, whole, kAll); });
  const bool asPieces = accepted([&] { readObj(obj, materials, ignore, pieces, kPiece); });
  require(asWhole == asPieces, "pieces are accepted where the whole is");
  if (!asWhole) return;
  require(whole.mesh.positions.size() == pieces.mesh.positions.size() &&
              whole.mesh.normals.size() == pieces.mesh.normals.size() &&
              whole.mesh.uvs.size() == pieces.mesh.uvs.size(),
          "pieces have the vertices of the whole");
  require(whole.mesh.corners == pieces.mesh.corners && whole.mesh.counts == pieces.mesh.counts &&
              whole.mesh.materials == pieces.mesh.materials,
          "pieces have the faces of the whole");
  require(whole.unknown == pieces.unknown, "pieces ask for the materials of the whole");
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder = makeFolder();
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const size_t split = std::min(input.find(kMtl), input.size());
  const fs::path obj = folder.write("m.obj", input.substr(0, split));
  const fs::path mtl = folder.write("m.mtl", input.substr(split));
  folder.write("my m.mtl", input.substr(split));
  requireSameInPieces(obj, {});
  requireSameInPieces(obj, mtl);
  load(obj, {}, {});
  load(obj, mtl, Affine::fromParts({1, 2, 3}, {0.1f, 0.2f, 0.3f}, {-1, 2, 1}));
  return 0;
}
