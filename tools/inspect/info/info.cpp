#include "tools/inspect/info/info.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "formats/image/exr_io.h"
#include "formats/vpl/vpl_io.h"
#include "tools/inspect/column_names.h"
#include "tools/inspect/file_kind.h"
#include "tools/inspect/info/shard_report.h"
#include "tools/inspect/info/spacing.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {
namespace {

struct Range {
  double min = INFINITY, max = -INFINITY, sum = 0.0;
  uint64_t finite = 0, other = 0;
  void add(double value) {
    if (!std::isfinite(value)) {
      ++other;
      return;
    }
    min = std::min(min, value);
    max = std::max(max, value);
    sum += value;
    ++finite;
  }
};

Json rangeJson(const std::string& name, const Range& range) {
  Json json{{"name", name}, {"min", nullptr}, {"max", nullptr}, {"mean", nullptr}};
  if (range.finite > 0) {
    json["min"] = range.min;
    json["max"] = range.max;
    json["mean"] = range.sum / double(range.finite);
  }
  return json;
}

// Lists the range of each component. Columns with more than kMaxListed components have one range
// for each part (such as x, y and z), or a single range if they have no parts.
Json columnsJson(const VplTable& table) {
  constexpr uint32_t kMaxListed = 4;
  Json columns = Json::array();
  for (const VplColumnView& column : columnsOf(table)) {
    const size_t listed = column.components <= kMaxListed ? column.components
                          : column.parts.empty()          ? 1
                                                          : column.parts.size();
    std::vector<Range> ranges(listed);
    for (size_t row = 0; row < table.size(); ++row) {
      for (size_t k = 0; k < column.components; ++k) ranges[k % listed].add(column.value(row, k));
    }
    for (size_t k = 0; k < ranges.size(); ++k) {
      const std::string name =
          listed == column.components ? componentName(column, k)
          : column.parts.empty()
              ? std::string(column.name) + "[" + std::to_string(column.components) + "]"
              : std::string(column.name) + "." + column.parts[k];
      Json json = rangeJson(name, ranges[k]);
      json["unit"] = column.unit;
      json["meaning"] = column.meaning;
      columns.push_back(std::move(json));
    }
  }
  return columns;
}

Json methodColumnsJson(const VplTable& table) {
  Json columns = Json::array();
  const std::vector<VplColumnView> all = columnsOf(table);
  for (const VplColumnView& column : std::span(all).last(table.extras.size())) {
    columns.push_back(
        {{"name", column.name}, {"type", nameOf(column.type)}, {"components", column.components}});
  }
  return columns;
}

Json energyJson(const VplTable& table) {
  double r = 0.0, g = 0.0, b = 0.0;
  for (const Vec3& f : table.flux) {
    r += double{f.x};
    g += double{f.y};
    b += double{f.z};
  }
  return {{"R", r}, {"G", g}, {"B", b}, {"mean", (r + g + b) / 3.0}};
}

Json spacingJson(const VplTable& table) {
  const Spacing s = measureSpacing(table);
  Json json{{"measured", s.measured}, {"alone", s.alone}};
  if (s.measured == 0) return json;
  json["distance"] = {{"min", s.minDistance}, {"mean", s.meanDistance}};
  if (table.rMax > 0.0) json["over_2_r_max"] = {{"min", s.minRelative}, {"mean", s.meanRelative}};
  if (!table.radius.empty()) json["over_own_radii"] = {{"min", s.minOwn}, {"mean", s.meanOwn}};
  return json;
}

Json provenanceJson(const std::string& text) {
  return text.empty() ? Json::array() : parseJson(text);
}

}  // namespace

Json describeTable(const VplTable& table) {
  Json json{{"format", "vpl"},
            {"stage", stageName(table.stage)},
            {"rows", table.size()},
            {"scene", hashText(table.sceneHash)},
            {"checksum", hashText(table.checksum)}};
  if (table.rMax > 0.0) json["r_max"] = table.rMax;
  if (table.areaEstimate > 0.0) json["area_estimate"] = table.areaEstimate;
  json["indirect_share"] = table.indirectShare;
  json["provenance"] = provenanceJson(table.provenance);
  json["columns"] = columnsJson(table);
  if (!table.extras.empty()) json["method_columns"] = methodColumnsJson(table);
  if (table.stage == VplStage::Lit) json["energy_W"] = energyJson(table);
  json["spacing"] = spacingJson(table);
  return json;
}

Json describeImage(const Image& image) {
  Json json{{"format", "exr"}, {"width", image.width}, {"height", image.height}};
  json["provenance"] = provenanceJson(provenanceOf(image));
  json["attributes"] = Json::object();
  for (const auto& [name, value] : image.attributes) {
    if (name != kProvenanceAttribute) json["attributes"][name] = value;
  }
  json["columns"] = Json::array();
  const PixelBox window = dataWindowOf(image);
  if (window != PixelBox{0, 0, image.width, image.height})
    json["data_window"] = {window.x0, window.y0, window.x1, window.y1};
  for (const ImageChannel& channel : image.channels) {
    Range range;
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x)
        range.add(double{channel.data[size_t(y) * size_t(image.width) + size_t(x)]});
    }
    Json entry = rangeJson(channel.name, range);
    entry["not_finite"] = range.other;
    json["columns"].push_back(std::move(entry));
  }
  return json;
}

Json describeFile(const fs::path& file) {
  Json json{{"file", file.string()}, {"bytes", nullptr}};
  const FileKind kind = fileKind(file);
  if (kind == FileKind::Vpl) {
    const VplTable table = readVpl(file);
    json["version"] = readVplHeader(file).version;
    json.update(describeTable(table));
  } else if (kind == FileKind::Shard) {
    json.update(describeShard(file));
  } else {
    const Image image = readExr(file);
    parseProvenance(file, provenanceOf(image));  // throws when it is damaged
    json.update(describeImage(image));
  }
  json["bytes"] = fs::file_size(file);
  return json;
}

}  // namespace bnvpl
