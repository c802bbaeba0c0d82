#include "formats/provenance.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace bnvpl {
namespace {

using Json = nlohmann::json;

// The string under `key` of an object, if it is a plain word that is safe in a message; else empty.
std::string wordAt(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return "";
  const std::string word = found->get<std::string>();
  const bool plain =
      word.size() <= 64 && std::all_of(word.begin(), word.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
      });
  return plain ? word : "";
}

}  // namespace

bool isProvenance(const std::string& text) {
  // The parser treats a zero byte as the end of the text, and would ignore what follows.
  if (text.find('\0') != std::string::npos) return false;
  bool deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, const Json&) {
    deep = deep || depth > kMaxProvenanceDepth;
    return !deep;
  };
  const auto json = Json::parse(text, keep, /*allow_exceptions=*/false);
  return !deep && json.is_array() && std::all_of(json.begin(), json.end(), [](const auto& record) {
    return record.is_object();
  });
}

std::string makerOf(const std::string& text) {
  if (!isProvenance(text)) return "";
  const Json history = Json::parse(text);
  if (history.empty()) return "";
  std::string tool = wordAt(history.back(), "tool");
  const auto options = history.back().find("options");
  if (tool.empty() || options == history.back().end() || !options->is_object()) return tool;
  const std::string method = wordAt(*options, "method");
  return method.empty() ? tool : tool + " --method " + method;
}

}  // namespace bnvpl
