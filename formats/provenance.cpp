#include "formats/provenance.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace bnvpl {

bool isProvenance(const std::string& text) {
  // The parser takes a zero byte for the end of the text; here it would hide what follows.
  if (text.find('\0') != std::string::npos) return false;
  bool deep = false;
  const auto keep = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    deep = deep || depth > kMaxProvenanceDepth;
    return !deep;
  };
  const auto json = nlohmann::json::parse(text, keep, /*allow_exceptions=*/false);
  return !deep && json.is_array() && std::all_of(json.begin(), json.end(), [](const auto& record) {
    return record.is_object();
  });
}

}  // namespace bnvpl
