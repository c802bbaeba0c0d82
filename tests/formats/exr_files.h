// An OpenEXR image for tests, and its header.
#pragma once

#include "formats/image/exr_io.h"
#include "tests/formats/test_files.h"

namespace bnvpl {

inline Image layeredImage() {
  Image image;
  image.width = 37;  // no multiple of a block, and more lines than one ZIP block
  image.height = 21;
  for (const char* name : {"R", "G", "B", "direct.R", "albedo.R", "N.X", "Z", "cutsize"}) {
    const float scale = static_cast<float>(image.channels.size()) + 1.0f;
    std::vector<float>& data = image.add(name);
    for (size_t i = 0; i < data.size(); ++i) data[i] = scale * static_cast<float>(i) / 128.0f;
  }
  image.attributes["bnvpl.provenance"] = R"([{"tool":"vpl-place","version":"0.1.0"}])";
  image.attributes["bnvpl.spp"] = "8";
  image.attributes["comments"] = "";
  return image;
}

// Offset of a header attribute's payload, which follows its name, its type and a 32-bit size.
inline size_t attributeOffset(const std::string& bytes, const std::string& name,
                              const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  return bytes.find(key) + key.size() + 4;
}

}  // namespace bnvpl
