// The table of VPLs that stages read and write, as columns (structure of arrays).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

enum class VplStage : uint32_t { Candidates = 1, Eliminated = 2, Lit = 3 };

// An extra column, which a method of a stage adds under its own name. Tools that do not know it
// keep it.
struct VplExtraColumn {
  std::string name;         // METHOD.COLUMN, such as "rich.lobes": formats/README.md
  std::string unit = "1";   // see formats/README.md, "Column directory"
  uint32_t components = 1;  // number of values per row
  std::variant<std::vector<float>, std::vector<uint32_t>, std::vector<uint64_t>> values;

  friend bool operator==(const VplExtraColumn&, const VplExtraColumn&) = default;
};

// Owns the columns. Every column of the stage has size() rows, with emitPoints elements per row in
// emitPosition and emitNormal; the columns of later stages are empty. Meanings, units and valid
// values are in vpl_columns.h.
struct VplTable {
  VplStage stage = VplStage::Candidates;

  // since Candidates
  std::vector<Vec3> position, normal, albedo;
  std::vector<uint32_t> id;
  // Mean over the view of the share of its light that is indirect, 0 to 1; 1 where it is not known.
  double indirectShare = 1.0;

  // since Eliminated
  std::vector<float> radius;
  double rMax = 0.0;          // r_max for areaEstimate (uniform density), world units
  double areaEstimate = 0.0;  // indirectly visible area, world units squared

  // since Lit
  // Distance from which light was collected for a VPL, in units of its radius; 0: placed from the
  // lights.
  double reachFactor = 0.0;
  std::vector<Vec3> flux;
  std::vector<uint64_t> photons;
  std::vector<float> relativeError;
  uint32_t emitPoints = 1;  // elements per row of the next two columns, row after row
  std::vector<Vec3> emitPosition, emitNormal;
  std::vector<Vec3> firstBounceFlux;

  std::vector<VplExtraColumn> extras;  // in the order of addition

  uint64_t sceneHash = 0;  // content hash of the scene that the rows lie on
  std::string provenance;  // JSON array, oldest stage first; see formats/README.md
  uint64_t checksum = 0;   // checksum of the file from which the table was read; 0 for a new table

  size_t size() const { return position.size(); }
};

// The given rows in the given order, with all columns, extra ones included, and the table's other
// members; the checksum is 0. Each of `rows` must be below table.size().
VplTable keepRows(const VplTable& table, std::span<const uint32_t> rows);

}  // namespace bnvpl
