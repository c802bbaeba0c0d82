// The columns of .vpl files. Layout, reading, writing, validation, vpl-inspect and the table in
// README.md derive from kVplColumns. A new column needs a member of VplTable, an entry here behind
// the others of its stage, and a new kVplVersion.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

enum class VplType : uint32_t { F32 = 1, U32 = 2, U64 = 3 };
constexpr size_t sizeOf(VplType type) { return type == VplType::U64 ? 8 : 4; }
std::string_view nameOf(VplType type);  // "f32"

// Which values a column may hold. problem() describes what is wrong with the value of a row, or
// returns null; a scalar is passed as three equal components. If `problem` is null, any value is
// valid.
struct VplCheck {
  std::string_view valid;
  const char* (*problem)(Vec3 value, const VplTable& table, size_t row);
};
namespace vpl_check {
const char* finite(Vec3 value, const VplTable& table, size_t row);
const char* unitLength(Vec3 value, const VplTable& table, size_t row);
const char* fraction(Vec3 value, const VplTable& table, size_t row);
const char* length(Vec3 value, const VplTable& table, size_t row);
const char* zeroOrMore(Vec3 value, const VplTable& table, size_t row);
const char* partOfFlux(Vec3 value, const VplTable& table, size_t row);
inline constexpr VplCheck kAny{"any", nullptr};
inline constexpr VplCheck kFinite{"finite", finite};
inline constexpr VplCheck kUnitLength{"length 1 ± 0.001", unitLength};
inline constexpr VplCheck kFraction{"0 to 1, ± 0.0001", fraction};
inline constexpr VplCheck kLength{"above 0, to 4e9", length};  // no scene is larger
inline constexpr VplCheck kZeroOrMore{"0 or more", zeroOrMore};
inline constexpr VplCheck kPartOfFlux{"0 to flux", partOfFlux};
}  // namespace vpl_check

using VplMember =
    std::variant<std::vector<Vec3> VplTable::*, std::vector<float> VplTable::*,
                 std::vector<uint32_t> VplTable::*, std::vector<uint64_t> VplTable::*>;

// A standard column. Its type and components follow from the member.
struct VplColumn {
  std::string_view name;
  VplMember member;
  std::string_view parts;  // names of a Vec3's components, "xyz" or "rgb"
  std::string_view unit;   // "1": dimensionless, "-": an identifier
  VplStage since;
  VplCheck check;
  std::string_view meaning;
  bool ofEmitPoints = false;  // whether a row has VplTable::emitPoints elements instead of one

  constexpr VplType type() const {
    return member.index() < 2 ? VplType::F32 : member.index() == 2 ? VplType::U32 : VplType::U64;
  }
  constexpr uint32_t components() const { return member.index() == 0 ? 3 : 1; }  // per element
  constexpr uint32_t elements(const VplTable& table) const {                     // per row
    return ofEmitPoints ? table.emitPoints : 1;
  }
};

// Max number of points from which a VPL emits.
inline constexpr uint32_t kMaxEmitPoints = 64;

inline constexpr std::array<VplColumn, 11> kVplColumns{{
    {"position", &VplTable::position, "xyz", "scene unit", VplStage::Candidates, vpl_check::kFinite,
     "world space"},
    {"normal", &VplTable::normal, "xyz", "1", VplStage::Candidates, vpl_check::kUnitLength,
     "geometric normal on the lit side"},
    {"albedo", &VplTable::albedo, "rgb", "1", VplStage::Candidates, vpl_check::kFraction,
     "of the rough lobes: fraction of the incident flux that leaves again, linear sRGB"},
    {"id", &VplTable::id, "", "-", VplStage::Candidates, vpl_check::kAny,
     "row in path order at placement; survives every stage"},
    {"radius", &VplTable::radius, "", "scene unit", VplStage::Eliminated, vpl_check::kLength,
     "of the disk that this VPL stands for: 2√3 · radius² of surface"},
    {"flux", &VplTable::flux, "rgb", "W", VplStage::Lit, vpl_check::kZeroOrMore,
     "leaving this VPL's share of the surface, linear sRGB"},
    {"photons", &VplTable::photons, "", "1", VplStage::Lit, vpl_check::kAny, "deposits received"},
    {"relative_error", &VplTable::relativeError, "", "1", VplStage::Lit, vpl_check::kZeroOrMore,
     "standard error of the flux over the flux; 0 without flux"},
    {"emit_position", &VplTable::emitPosition, "xyz", "scene unit", VplStage::Lit,
     vpl_check::kFinite,
     "where the light leaves from, in equal parts: one point or more of the surface near position",
     true},
    {"emit_normal", &VplTable::emitNormal, "xyz", "1", VplStage::Lit, vpl_check::kUnitLength,
     "geometric normal at each of these points", true},
    {"first_bounce_flux", &VplTable::firstBounceFlux, "rgb", "W", VplStage::Lit,
     vpl_check::kPartOfFlux, "the part of the flux that came straight from a light"},
}};
static_assert(std::is_sorted(kVplColumns.begin(), kVplColumns.end(),
                             [](const VplColumn& a, const VplColumn& b) {
                               return a.since < b.since;
                             }),
              "the columns of a stage are the first ones");

// The columns that every file of the stage has, in file order.
constexpr std::span<const VplColumn> standardColumns(VplStage stage) {
  const auto last = std::find_if(kVplColumns.begin(), kVplColumns.end(),
                                 [&](const VplColumn& column) { return column.since > stage; });
  return {kVplColumns.begin(), last};
}

// One column of a table, standard or extra. Valid as long as the table does not change.
struct VplColumnView {
  std::string_view name, unit, meaning, parts;
  VplType type;
  uint32_t components;
  std::span<const std::byte> bytes;  // row after row

  uint64_t rowBytes() const { return sizeOf(type) * uint64_t{components}; }
  std::span<const std::byte> row(size_t row) const {
    return bytes.subspan(row * rowBytes(), rowBytes());
  }
  // Exact, except for u64 beyond 2^53.
  double value(size_t row, size_t component) const;
};

// All columns of the table in file order: the standard ones of its stage, then the extra ones.
std::vector<VplColumnView> columnsOf(const VplTable& table);

// Calls visit(values, perRow) for each column in the same order; the vector has perRow elements for
// each row. Table is VplTable or const VplTable.
template <typename Table, typename Visit>
void forEachColumn(Table& table, const Visit& visit) {
  for (const VplColumn& column : standardColumns(table.stage)) {
    std::visit([&](auto member) { visit(table.*member, size_t{column.elements(table)}); },
               column.member);
  }
  for (auto& extra : table.extras) {
    std::visit([&](auto& values) { visit(values, size_t{extra.components}); }, extra.values);
  }
}

}  // namespace bnvpl
