// scene.toml: an accepted file makes a valid scene. Its folder also has square.obj, square.mtl and
// t.tga.
#include <fstream>

#include "fuzz/sane_scene.h"
#include "fuzz/tiny_tga.h"
#include "scene/load_scene.h"

namespace bnvpl {
namespace {

constexpr std::string_view kSquare =
    "mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nvn 0 0 1\nvt 0 0\nvt 1 1\nusemtl a\n"
    "f 1/1/1 2/2/1 3/1/1\n";

InputFolder makeFolder() {
  InputFolder folder;
  folder.write("square.obj", kSquare);
  folder.write("square.mtl", "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd t.tga\n");
  folder.write("t.tga", kTinyTga);
  return folder;
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder = makeFolder();
  const fs::path file = folder.write("scene.toml", {reinterpret_cast<const char*>(data), size});
  Scene scene;
  if (accepted([&] { scene = loadScene(file, {{"X", "."}}); })) requireSane(scene);
  return 0;
}
