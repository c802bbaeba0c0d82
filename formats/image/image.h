// An image of named float channels, as in OpenEXR: "R", "direct.R", "N.X", "Z", ...
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bnvpl {

struct ImageChannel {
  std::string name;
  std::vector<float> data;  // width * height values, row by row from the top
};

// The columns [x0, x1) and rows [y0, y1) of an image.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool operator==(const PixelBox&) const = default;
};

// The camera of an image as OpenEXR's standard attributes describe it (ImfStandardAttributes.h).
// Matrices multiply row vectors from the right, (x, y, z, 1) M, as Imath's do, and are stored row
// by row. World space is that of the scene's files.
struct ImageCamera {
  // Transform to the camera at the origin: x points to the right, y up, and z along the viewing
  // direction.
  std::array<float, 16> worldToCamera{};
  // Transform to (0, 0) at the upper left corner of the film and (1, 1) at the lower right one,
  // after division by the fourth coordinate.
  std::array<float, 16> worldToNdc{};
  // Width and centre of the film on the plane at distance 1 from the camera; y points up.
  float screenWindowWidth = 1.0f;
  std::array<float, 2> screenWindowCenter{};
  bool operator==(const ImageCamera&) const = default;
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<ImageChannel> channels;
  std::map<std::string, std::string> attributes;
  std::optional<PixelBox> dataWindow;  // the pixels that have values; the others are 0. None: all
  std::optional<ImageCamera> camera;
  // The CIE x and y of red, green, blue and white, as a file states them. Images are written with
  // those of Rec. 709.
  std::optional<std::array<float, 8>> chromaticities;
  int parts = 1;  // parts that the file has; the first is the image

  size_t pixelCount() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }

  // Appends a channel of zeros. The reference is valid until the next channel is added.
  std::vector<float>& add(std::string name) {
    channels.push_back({std::move(name), std::vector<float>(pixelCount(), 0.0f)});
    return channels.back().data;
  }
  // The values of the channel `name`, or null if there is none.
  const std::vector<float>* find(const std::string& name) const {
    for (const ImageChannel& channel : channels) {
      if (channel.name == name) return &channel.data;
    }
    return nullptr;
  }
};

// The pixels that have values.
inline PixelBox dataWindowOf(const Image& image) {
  return image.dataWindow.value_or(PixelBox{0, 0, image.width, image.height});
}

}  // namespace bnvpl
