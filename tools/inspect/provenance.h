// The history that every file carries: tools, options and inputs that made it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/image/image.h"
#include "tools/common/run/run_tool.h"

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
  std::vector<View> views;  // views that the stage used
  std::string processor;    // "any"; empty: the processor at hand
};

// Records, oldest first; missing keys stay empty, and an empty text has no records. Throws
// InputError, which names `file`, if `text` is not a JSON array of objects.
std::vector<StageRecord> parseProvenance(const fs::path& file, const std::string& text);

// The provenance attribute of an image; empty if it has none.
std::string provenanceOf(const Image& image);

// "vpl-place 0.1.0: count 3000, seed 1; from scene HASH; view 640x480 HASH", with at most four
// views.
std::string describeRecord(const StageRecord& record);
std::string describeViews(const StageRecord& record);

}  // namespace bnvpl
