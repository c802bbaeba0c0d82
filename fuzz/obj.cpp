// OBJ and MTL: what ObjLoader accepts are triangles, materials and textures that can be used.
//
// The input is an OBJ; from a line "# MTL" on it is m.mtl, which the OBJ can name. t.tga lies
// beside them. It is loaded as a scene names it: plain, and mirrored with m.mtl in place of its
// libraries.
#include "fuzz/sane_scene.h"
#include "fuzz/tiny_tga.h"
#include "scene/load_obj.h"

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
    ObjLoader loader(scene);
    loader.load(obj, materials, transform);
    loader.finish();
  };
  if (accepted(read)) requireSaneMeshes(scene);
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
  load(obj, {}, {});
  load(obj, mtl, Affine::fromParts({1, 2, 3}, {0.1f, 0.2f, 0.3f}, {-1, 2, 1}));
  return 0;
}
