// Textures, environments and masks in any of PNG, JPEG, TGA, BMP, HDR, PFM and EXR.
#include "fuzz/sane_scene.h"
#include "images/mask.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder;
  const fs::path file = folder.write("image", {reinterpret_cast<const char*>(data), size});

  EnvironmentImage environment;
  size_t negative = 0;
  if (accepted([&] { environment = loadEnvironment(file, negative); })) requireSane(environment);

  Texture texture;
  if (!accepted([&] { texture = loadTexture(file, true, true); })) return 0;
  requireSane(texture);

  Layer layer;  // has the size that the mask must have
  layer.width = static_cast<int>(texture.width);
  layer.height = static_cast<int>(texture.height);
  Mask mask;
  if (!accepted([&] { mask = readMask(file, "layer", layer); })) return 0;
  for (const double weight : mask.weights)
    require(weight >= 0 && weight <= 1, "weights are shares");
  require(mask.sum(mask.weights.size()) > 0, "something counts");
  return 0;
}
