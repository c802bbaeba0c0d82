// .pbrt and PLY: an accepted file makes a valid scene.
//
// The input is scene.pbrt; from a line "# PLY" on it is m.ply, to which the scene can refer. The
// folder also has t.tga, sky.pfm, a.spd and more.pbrt, which includes scene.pbrt.
#include "fuzz/sane_scene.h"
#include "fuzz/tiny_tga.h"
#include "scene/load_scene.h"

namespace bnvpl {
namespace {

constexpr std::string_view kPly = "# PLY\n";

InputFolder makeFolder() {
  InputFolder folder;
  folder.write("t.tga", kTinyTga);
  folder.write("sky.pfm", "PF\n1 1\n1\n" + std::string(12, '\x3f'));
  folder.write("a.spd", "400 0.5\n700 0.6\n");
  folder.write("more.pbrt", "Translate 1 0 0\nInclude \"scene.pbrt\"\n");
  return folder;
}

size_t count(std::string_view text, std::string_view word) {
  size_t n = 0;
  for (size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++n;
  return n;
}

// Valid scenes can be large, with many spheres in many instances; these are skipped.
bool isSmall(std::string_view text) {
  return count(text, "Shape") <= 40 && count(text, "ObjectInstance") <= 4;
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder = makeFolder();
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const size_t split = std::min(input.find(kPly), input.size());
  if (!isSmall(input.substr(0, split))) return 0;
  const fs::path file = folder.write("scene.pbrt", input.substr(0, split));
  const size_t ply = std::min(split + kPly.size(), input.size());
  folder.write("m.ply", input.substr(ply));
  Scene scene;
  if (accepted([&] { scene = loadScene(file); })) requireSane(scene);
  return 0;
}
