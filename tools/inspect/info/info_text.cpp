#include <algorithm>
#include <cstdio>

#include "tools/inspect/append_text.h"
#include "tools/inspect/info/info.h"
#include "tools/inspect/info/shard_report.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {
namespace {

std::string number(const Json& value) {
  if (!value.is_number()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value.get<double>());
  return text;
}

std::string word(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end()) return "";
  return found->is_string() ? found->get<std::string>() : jsonText(*found);
}

void appendHead(std::string& text, const Json& d) {
  if (d["format"] == "exr") {
    append(text, "%s: OpenEXR, %s x %s pixels, %s bytes\n", word(d, "file").c_str(),
           word(d, "width").c_str(), word(d, "height").c_str(), word(d, "bytes").c_str());
    if (d.contains("data_window")) {
      const Json& w = d["data_window"];
      append(text, "  a crop: columns %d to %d, rows %d to %d; the figures are of these pixels\n",
             w[0].get<int>(), w[2].get<int>() - 1, w[1].get<int>(), w[3].get<int>() - 1);
    }
    for (const auto& [name, value] : d["attributes"].items()) {
      text += "  " + name + " = " + value.get<std::string>() + "\n";
    }
    return;
  }
  append(text, "%s: %s, %s rows, %s bytes, format version %s\n", word(d, "file").c_str(),
         word(d, "stage").c_str(), word(d, "rows").c_str(), word(d, "bytes").c_str(),
         word(d, "version").c_str());
  append(text, "  scene %s, checksum %s\n", word(d, "scene").c_str(), word(d, "checksum").c_str());
  if (d.contains("r_max")) {
    append(text, "  r_max %s scene units, area %s scene units squared\n",
           number(d["r_max"]).c_str(),
           d.contains("area_estimate") ? number(d["area_estimate"]).c_str() : "unknown");
  }
  append(text, "  share of the light in view that is indirect %.3g\n",
         d["indirect_share"].get<double>());
}

void appendProvenance(std::string& text, const Json& d) {
  const auto chain = parseProvenance(word(d, "file"), jsonText(d["provenance"]));
  text += chain.empty() ? "made by: no record\n" : "made by:\n";
  for (const StageRecord& record : chain) text += "  " + describeRecord(record) + "\n";
}

void appendColumns(std::string& text, const Json& d) {
  size_t longest = 16;
  for (const Json& c : d["columns"]) longest = std::max(longest, word(c, "name").size());
  const int width = static_cast<int>(longest);
  append(text, "%-*s %13s %13s %13s\n", width + 2, d["format"] == "exr" ? "channel" : "column",
         "min", "max", "mean");
  for (const Json& c : d["columns"]) {
    append(text, "  %-*s %13s %13s %13s", width, word(c, "name").c_str(), number(c["min"]).c_str(),
           number(c["max"]).c_str(), number(c["mean"]).c_str());
    const std::string unit = word(c, "unit");
    if (!unit.empty() && unit != "1" && unit != "-") text += "  " + unit;
    if (c.contains("not_finite") && c["not_finite"] != 0) {
      text += "  and " + word(c, "not_finite") + " not finite";
    }
    text += "\n";
  }
}

void appendMethodColumns(std::string& text, const Json& columns) {
  text += "columns of methods, which all stages keep:";
  std::string separator = " ";
  for (const Json& c : columns) {
    text += separator + word(c, "name") + " (" + word(c, "type");
    if (c["components"] != 1) text += " x " + word(c, "components");
    text += ")";
    separator = ", ";
  }
  text += "\n";
}

void appendSpacing(std::string& text, const Json& s) {
  text += "nearest neighbour on a compatible surface:\n";
  const auto line = [&](const char* key, const char* label) {
    if (!s.contains(key)) return;
    append(text, "  %-28s min %s, mean %s\n", label, number(s[key]["min"]).c_str(),
           number(s[key]["mean"]).c_str());
  };
  line("distance", "distance, scene units");
  line("over_2_r_max", "distance / (2 r_max)");
  line("over_own_radii", "distance / (sum of radii)");
  append(text, "  %s rows, and %s without a neighbour\n", word(s, "measured").c_str(),
         word(s, "alone").c_str());
}

}  // namespace

std::string infoText(const Json& asFound) {
  const Json description = withEscapedNames(asFound);
  if (description["format"] == "shard") return shardText(description);
  std::string text;
  appendHead(text, description);
  appendProvenance(text, description);
  appendColumns(text, description);
  if (description.contains("method_columns"))
    appendMethodColumns(text, description["method_columns"]);
  if (description.contains("energy_W")) {
    const Json& e = description["energy_W"];
    append(text, "energy: R %s, G %s, B %s W, mean %s W\n", number(e["R"]).c_str(),
           number(e["G"]).c_str(), number(e["B"]).c_str(), number(e["mean"]).c_str());
  }
  if (description.contains("spacing")) appendSpacing(text, description["spacing"]);
  return text;
}

}  // namespace bnvpl
