#include "images/layer.h"

#include <cmath>
#include <set>

namespace bnvpl {
namespace {

bool take(const Image& image, const std::vector<std::string>& names, Layer& layer) {
  layer.channels.clear();
  layer.data.clear();
  for (const std::string& name : names) {
    const std::vector<float>* data = image.find(name);
    if (data == nullptr) return false;
    layer.channels.push_back(name);
    layer.data.push_back(data);
  }
  return true;
}

std::string layerNames(const Image& image) {
  std::set<std::string> names;
  for (const ImageChannel& channel : image.channels) {
    const size_t dot = channel.name.rfind('.');
    names.insert(dot == std::string::npos ? channel.name : channel.name.substr(0, dot));
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "nothing" : text;
}

std::string shapeText(const Layer& layer) {
  return std::to_string(layer.width) + " x " + std::to_string(layer.height) + " pixels of " +
         std::to_string(layer.data.size()) + " channels";
}

}  // namespace

Layer findLayer(const fs::path& file, const Image& image, const std::string& name) {
  Layer layer;
  layer.name = name;
  layer.width = image.width;
  layer.height = image.height;
  const std::string dot = name.empty() ? "" : name + ".";
  if (take(image, {dot + "R", dot + "G", dot + "B"}, layer)) return layer;
  if (take(image, {dot + "X", dot + "Y", dot + "Z"}, layer)) return layer;
  if (!name.empty() && take(image, {name}, layer)) return layer;
  throw InputError(file,
                   (name.empty() ? "has no channels R, G, B" : "has no layer '" + name + "'") +
                       "; it holds " + layerNames(image));
}

void requireFinite(const fs::path& file, const Layer& layer) {
  for (size_t c = 0; c < layer.data.size(); ++c) {
    for (size_t i = 0; i < layer.data[c]->size(); ++i) {
      if (std::isfinite((*layer.data[c])[i])) continue;
      const size_t width = static_cast<size_t>(layer.width);
      throw InputError(file, "channel " + layer.channels[c] + " is not finite at pixel (" +
                                 std::to_string(i % width) + ", " + std::to_string(i / width) +
                                 "); " +
                                 (layer.channels[c] == "Z" ? "depth has no bound where the camera "
                                                             "sees no surface: compare crops "
                                                             "without background"
                                                           : "rerun vpl-render"));
    }
  }
}

void requireSameShape(const fs::path& file, const Layer& layer, const std::string& other,
                      const Layer& expected) {
  if (layer.width == expected.width && layer.height == expected.height &&
      layer.data.size() == expected.data.size()) {
    return;
  }
  throw InputError(file, shapeText(layer) + ", but " + other + " has " + shapeText(expected) +
                             "; render both from one scene.toml");
}

Image meanOf(const Layer& a, const Layer& b) {
  Image mean;
  mean.width = a.width;
  mean.height = a.height;
  for (size_t c = 0; c < a.data.size(); ++c) {
    std::vector<float>& values = mean.add(a.channels[c]);
    for (size_t i = 0; i < values.size(); ++i) {
      // In doubles, because the sum of two large floats may overflow.
      values[i] = static_cast<float>(0.5 * (double{(*a.data[c])[i]} + double{(*b.data[c])[i]}));
    }
  }
  return mean;
}

}  // namespace bnvpl
