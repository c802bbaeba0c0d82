// An image of named float channels, as in OpenEXR: "R", "direct.R", "N.X", "Z", ...
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bnvpl {

struct ImageChannel {
  std::string name;
  std::vector<float> data;  // width * height values, row by row from the top
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<ImageChannel> channels;
  std::map<std::string, std::string> attributes;

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

}  // namespace bnvpl
