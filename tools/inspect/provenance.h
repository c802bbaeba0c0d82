// The history that every file carries: which tools made it, with what, from what.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/image.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

inline constexpr const char* kProvenanceAttribute = "bnvpl.provenance";

struct StageRecord {
  std::string tool, version;
  Json options = Json::object();
  std::map<std::string, std::string>
      inputs;  // "scene", "candidates", "vpls", "lit" -> 16 hex digits
  struct View {
    std::string size, hash;  // "640x480" and 16 hex digits
    bool operator==(const View&) const = default;
  };
  std::vector<View> views;  // that the stage looked at
  std::string processor;    // "any"; empty: the one at hand
};

// Oldest first; keys that are absent stay empty. `file` is for the message.
// Throws InputError when `text` is not a JSON array of objects. An empty text is an empty chain.
std::vector<StageRecord> parseProvenance(const fs::path& file, const std::string& text);

// The provenance attribute of an image, or an empty text.
std::string provenanceOf(const Image& image);

// "vpl-place 0.1.0: count 3000, seed 1; from scene 0123456789abcdef; view 640x480
// 0123456789abcdef"; of many views the first few
std::string describeRecord(const StageRecord& record);
std::string describeViews(const StageRecord& record);

}  // namespace bnvpl
