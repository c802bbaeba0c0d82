// EXR files, as images of `vpl-inspect compare` and as environments.
#include "formats/image/exr_io.h"
#include "fuzz/sane_scene.h"
#include "images/comparison.h"

namespace bnvpl {
namespace {

void compareWithItself(const fs::path& file, const Image& image, const std::string& name) {
  Layer layer;
  Comparison c;
  const auto compare = [&] {
    layer = findLayer(file, image, name);
    c = compareLayers(file, layer, file, layer, kRelMseEpsilon, &layer);
  };
  if (!accepted(compare)) return;
  require(layer.pixelCount() == image.pixelCount(), "a layer has all pixels");
  require(c.rmse == 0 && c.relMse == 0 && c.smape == 0, "an image equals itself");
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder;
  const fs::path file = folder.write("in.exr", {reinterpret_cast<const char*>(data), size});
  Image image;
  if (!accepted([&] { image = readExr(file); })) return 0;
  require(image.width > 0 && image.height > 0, "an image has a size");
  for (const ImageChannel& channel : image.channels) {
    require(channel.data.size() == image.pixelCount(), "a channel has all pixels");
    compareWithItself(file, image, channel.name);
  }
  compareWithItself(file, image, "");
  EnvironmentImage environment;
  size_t negative = 0;
  if (accepted([&] { environment = loadEnvironment(file, negative); })) requireSane(environment);
  return 0;
}
