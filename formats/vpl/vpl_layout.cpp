#include "formats/vpl/vpl_layout.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <string_view>

namespace bnvpl {
namespace {

template <size_t Size>
std::array<char, Size> padded(std::string_view text) {
  std::array<char, Size> result{};
  std::copy(text.begin(), text.end(), result.begin());
  return result;
}

Vec3 asVec3(Vec3 value) { return value; }
template <typename T>
Vec3 asVec3(T value) {
  return Vec3(static_cast<float>(value));
}

// The first value that the column's check rejects.
template <typename T>
std::optional<BadValue> findIn(const VplTable& table, const std::vector<T>& values, size_t column,
                               const VplColumn& of) {
  for (size_t i = 0; of.check.problem != nullptr && i < values.size(); ++i) {
    const size_t row = i / of.elements(table);
    if (const char* problem = of.check.problem(asVec3(values[i]), table, row))
      return BadValue{column, row, problem};
  }
  return std::nullopt;
}

std::optional<BadValue> findNotFinite(const VplExtraColumn& extra, size_t column) {
  const auto* values = std::get_if<std::vector<float>>(&extra.values);
  if (values == nullptr) return std::nullopt;
  const auto bad =
      std::find_if(values->begin(), values->end(), [](float v) { return !std::isfinite(v); });
  if (bad == values->end()) return std::nullopt;
  return BadValue{column, static_cast<size_t>(bad - values->begin()) / extra.components,
                  "not a finite number"};
}

bool isWord(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

// Whether the name is two words separated by a dot, such as "rich.lobes".
bool isExtraName(std::string_view name) {
  const size_t dot = name.find('.');
  return name.size() < sizeof(VplColumnEntry::name) && dot != std::string_view::npos &&
         isWord(name.substr(0, dot)) && isWord(name.substr(dot + 1));
}

bool isUnit(std::string_view unit) {
  return !unit.empty() && unit.size() < sizeof(VplColumnEntry::unit) &&
         std::all_of(unit.begin(), unit.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

uint64_t rowBytes(const std::vector<VplColumnView>& columns) {
  uint64_t bytes = 0;
  for (const VplColumnView& column : columns) bytes += column.rowBytes();
  return bytes;
}

VplLayout makeLayout(const std::vector<VplColumnView>& columns, uint64_t count,
                     uint64_t provenanceBytes) {
  VplLayout layout;
  layout.provenanceOffset = sizeof(VplHeader) + columns.size() * sizeof(VplColumnEntry);
  uint64_t offset = alignUp(layout.provenanceOffset + provenanceBytes);
  for (const VplColumnView& column : columns) {
    const uint64_t bytes = count * column.rowBytes();
    layout.directory.push_back({padded<24>(column.name), column.type, column.components, offset,
                                bytes, padded<16>(column.unit)});
    offset = alignUp(offset + bytes);
  }
  layout.endMarkOffset = offset;
  layout.fileBytes = offset + kVplEndMark.size();
  return layout;
}

VplLayout makeLayout(VplStage stage, uint64_t count, uint64_t provenanceBytes) {
  VplTable table;
  table.stage = stage;
  return makeLayout(columnsOf(table), count, provenanceBytes);
}

std::optional<BadField> findBadField(const VplExtraColumn& column,
                                     std::span<const VplExtraColumn> earlier) {
  if (!isExtraName(column.name)) {
    return BadField{offsetof(VplColumnEntry, name),
                    "a method's column needs a name such as rich.lobes: small letters, digits, _ "
                    "and -, one dot, at most 23 bytes"};
  }
  if (std::any_of(earlier.begin(), earlier.end(),
                  [&](const VplExtraColumn& other) { return other.name == column.name; })) {
    return BadField{offsetof(VplColumnEntry, name), "a second column " + column.name};
  }
  if (column.components < 1 || column.components > kMaxExtraComponents) {
    return BadField{offsetof(VplColumnEntry, components),
                    "column " + column.name + " has " + std::to_string(column.components) +
                        " components, not 1 to " + std::to_string(kMaxExtraComponents)};
  }
  if (!isUnit(column.unit)) {
    return BadField{offsetof(VplColumnEntry, unit),
                    "the unit of column " + column.name + " is not 1 to 15 bytes of plain ASCII"};
  }
  return std::nullopt;
}

std::optional<BadValue> findBadValue(const VplTable& table) {
  size_t index = 0;
  for (const VplColumn& column : standardColumns(table.stage)) {
    auto bad = std::visit([&](auto member) { return findIn(table, table.*member, index, column); },
                          column.member);
    if (bad) return bad;
    ++index;
  }
  for (const VplExtraColumn& extra : table.extras) {
    if (auto bad = findNotFinite(extra, index)) return bad;
    ++index;
  }
  return std::nullopt;
}

bool isMeasure(double value) { return std::isfinite(value) && value >= 0.0; }

}  // namespace bnvpl
