#include "formats/vpl/vpl_columns.h"

#include <cmath>
#include <cstring>

namespace bnvpl {
namespace {

constexpr float kUnitLengthTolerance = 1e-3f;  // far above the rounding of float32 normals
constexpr float kFractionTolerance = 1e-4f;    // covers rounding of 8-bit textures and products
constexpr const char* kNotFinite = "not a finite number";

template <typename T>
double valueAt(std::span<const std::byte> bytes, size_t index) {
  T value;
  std::memcpy(&value, bytes.data() + index * sizeof value, sizeof value);
  return static_cast<double>(value);
}

// Copies the given rows of `from`, perRow elements each.
template <typename T>
std::vector<T> pickRows(const std::vector<T>& from, size_t perRow, std::span<const uint32_t> rows) {
  std::vector<T> picked;
  picked.reserve(rows.size() * perRow);
  for (const uint32_t row : rows) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(row * perRow);
    picked.insert(picked.end(), first, first + static_cast<std::ptrdiff_t>(perRow));
  }
  return picked;
}

}  // namespace

std::string_view nameOf(VplType type) {
  return type == VplType::F32 ? "f32" : type == VplType::U32 ? "u32" : "u64";
}

namespace vpl_check {
const char* finite(Vec3 value, const VplTable& /*table*/, size_t /*row*/) {
  return isFinite(value) ? nullptr : kNotFinite;
}
const char* unitLength(Vec3 value, const VplTable& /*table*/, size_t /*row*/) {
  if (!isFinite(value)) return kNotFinite;
  return std::fabs(length(value) - 1.0f) <= kUnitLengthTolerance ? nullptr : "not of unit length";
}
const char* fraction(Vec3 value, const VplTable& /*table*/, size_t /*row*/) {
  if (!isFinite(value)) return kNotFinite;
  const bool within = minComponent(value) >= -kFractionTolerance &&
                      maxComponent(value) <= 1.0f + kFractionTolerance;
  return within ? nullptr : "not between 0 and 1";
}
const char* length(Vec3 value, const VplTable& /*table*/, size_t /*row*/) {
  if (!isFinite(value)) return kNotFinite;
  if (!(minComponent(value) > 0.0f)) return "not above 0";
  return maxComponent(value) <= 4e9f ? nullptr : "larger than any scene";
}
const char* zeroOrMore(Vec3 value, const VplTable& /*table*/, size_t /*row*/) {
  if (!isFinite(value)) return kNotFinite;
  return minComponent(value) >= 0.0f ? nullptr : "negative";
}
const char* partOfFlux(Vec3 value, const VplTable& table, size_t row) {
  if (const char* problem = zeroOrMore(value, table, row)) return problem;
  return minComponent(table.flux[row] - value) >= 0.0f ? nullptr : "above the flux";
}
}  // namespace vpl_check

double VplColumnView::value(size_t row, size_t component) const {
  const size_t index = row * components + component;
  switch (type) {
    case VplType::F32:
      return valueAt<float>(bytes, index);
    case VplType::U32:
      return valueAt<uint32_t>(bytes, index);
    default:
      return valueAt<uint64_t>(bytes, index);
  }
}

std::vector<VplColumnView> columnsOf(const VplTable& table) {
  std::vector<VplColumnView> views;
  for (const VplColumn& c : standardColumns(table.stage)) {
    const auto bytes =
        std::visit([&](auto member) { return std::as_bytes(std::span(table.*member)); }, c.member);
    views.push_back(
        {c.name, c.unit, c.meaning, c.parts, c.type(), c.components() * c.elements(table), bytes});
  }
  for (const VplExtraColumn& extra : table.extras) {
    const auto bytes = std::visit(
        [](const auto& values) { return std::as_bytes(std::span(values)); }, extra.values);
    views.push_back({extra.name, extra.unit, "a method's own", "",
                     static_cast<VplType>(1 + extra.values.index()), extra.components, bytes});
  }
  return views;
}

VplTable keepRows(const VplTable& table, std::span<const uint32_t> rows) {
  VplTable kept;
  kept.stage = table.stage;
  kept.rMax = table.rMax;
  kept.areaEstimate = table.areaEstimate;
  kept.reachFactor = table.reachFactor;
  kept.indirectShare = table.indirectShare;
  kept.emitPoints = table.emitPoints;
  kept.sceneHash = table.sceneHash;
  kept.provenance = table.provenance;
  for (const VplColumn& column : standardColumns(table.stage)) {
    std::visit(
        [&](auto member) { kept.*member = pickRows(table.*member, column.elements(table), rows); },
        column.member);
  }
  for (const VplExtraColumn& extra : table.extras) {
    VplExtraColumn& to = kept.extras.emplace_back();
    to.name = extra.name;
    to.unit = extra.unit;
    to.components = extra.components;
    std::visit([&](const auto& values) { to.values = pickRows(values, extra.components, rows); },
               extra.values);
  }
  return kept;
}

}  // namespace bnvpl
