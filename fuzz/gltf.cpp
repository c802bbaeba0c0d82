// .gltf and .glb: an accepted file makes a valid scene. Its folder also has a.bin, the corners of a
// triangle, and t.tga.
#include "fuzz/sane_scene.h"
#include "fuzz/tiny_tga.h"
#include "scene/load_scene.h"

namespace bnvpl {
namespace {

InputFolder makeFolder() {
  InputFolder folder;
  folder.write("t.tga", kTinyTga);
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  folder.write("a.bin", {reinterpret_cast<const char*>(corners), sizeof corners});
  return folder;
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder = makeFolder();
  // The content decides between .gltf and .glb.
  const fs::path file = folder.write("scene.gltf", {reinterpret_cast<const char*>(data), size});
  Scene scene;
  if (accepted([&] { scene = loadScene(file); })) requireSane(scene);
  return 0;
}
