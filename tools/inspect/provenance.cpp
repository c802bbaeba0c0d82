#include "tools/inspect/provenance.h"

#include <algorithm>
#include <cstdio>
#include <span>

#include "formats/provenance.h"

namespace bnvpl {
namespace {

std::string plain(const Json& value) {
  if (value.is_number_float()) {  // prints a float 0.02 as such, not as 0.0199999996
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value.get<double>());
    return text;
  }
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  return value.is_string() ? value.get<std::string>() : jsonText(value);
}

// The record's text under `key`; empty if it is missing, as in histories of other programs.
std::string textAt(const Json& record, const char* key) {
  const auto found = record.find(key);
  return found == record.end() ? std::string() : plain(*found);
}

}  // namespace

std::vector<StageRecord> parseProvenance(const fs::path& file, const std::string& text) {
  std::vector<StageRecord> chain;
  if (text.empty()) return chain;
  if (!isProvenance(text)) {
    throw InputError(file,
                     "its provenance is not a JSON array of objects, or is nested too deeply");
  }
  const Json json = parseJson(text);
  for (const Json& entry : json) {
    StageRecord record;
    record.tool = textAt(entry, "tool");
    record.version = textAt(entry, "version");
    record.processor = textAt(entry, "processor");
    if (const auto it = entry.find("options"); it != entry.end() && it->is_object())
      record.options = *it;
    if (const auto it = entry.find("inputs"); it != entry.end() && it->is_object()) {
      for (const auto& [name, value] : it->items()) record.inputs[name] = plain(value);
    }
    const auto addView = [&](const Json& view) {
      if (view.is_object()) record.views.push_back({textAt(view, "size"), textAt(view, "hash")});
    };
    if (const auto it = entry.find("view"); it != entry.end()) addView(*it);
    if (const auto it = entry.find("views"); it != entry.end() && it->is_array())
      std::ranges::for_each(*it, addView);
    chain.push_back(std::move(record));
  }
  return chain;
}

std::string provenanceOf(const Image& image) {
  const auto found = image.attributes.find(kProvenanceAttribute);
  return found == image.attributes.end() ? std::string() : found->second;
}

std::string describeRecord(const StageRecord& record) {
  std::string line = (record.tool.empty() ? "(unnamed tool)" : record.tool) + " " + record.version;
  std::string separator = ": ";
  for (const auto& [name, value] : record.options.items()) {
    line.append(separator).append(name).append(" ").append(plain(value));
    separator = ", ";
  }
  separator = "; from ";
  for (const auto& [name, value] : record.inputs) {
    line.append(separator).append(name).append(" ").append(value);
    separator = ", ";
  }
  if (!record.processor.empty()) line += "; for " + record.processor + " processor";
  if (!record.views.empty()) line += "; " + describeViews(record);
  return line;
}

std::string describeViews(const StageRecord& record) {
  constexpr size_t kNamed = 4;
  std::string text = record.views.size() > 1 ? "views" : "view", separator = " ";
  for (const StageRecord::View& view :
       std::span(record.views).first(std::min(record.views.size(), kNamed))) {
    text.append(separator).append(view.size).append(" ").append(view.hash);
    separator = ", ";
  }
  if (record.views.size() > kNamed)
    text += " and " + std::to_string(record.views.size() - kNamed) + " more";
  return text;
}

}  // namespace bnvpl
