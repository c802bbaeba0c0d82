// The rows that travel from stage to stage, as columns (structure of arrays).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

enum class VplStage : uint32_t { Candidates = 1, Eliminated = 2, Lit = 3 };

// A column that a strategy adds under its own name. Tools that do not know it keep it.
struct VplExtraColumn {
  std::string name;         // "rich.lobes": README.md, "Columns of a strategy"
  std::string unit = "1";   // as in README.md, "Column directory"
  uint32_t components = 1;  // values of a row
  std::variant<std::vector<float>, std::vector<uint32_t>, std::vector<uint64_t>> values;

  friend bool operator==(const VplExtraColumn&, const VplExtraColumn&) = default;
};

// Owns the columns. Every column of the stage has size() rows (emitPosition and emitNormal
// emitPoints elements a row); the later stages' columns are empty. What the columns mean, their
// units and valid values: vpl_columns.h.
struct VplTable {
  VplStage stage = VplStage::Candidates;

  // since Candidates
  std::vector<Vec3> position, normal, albedo;
  std::vector<uint32_t> id;

  // since Eliminated
  std::vector<float> radius;
  double rMax = 0.0;          // r_max that belongs to areaEstimate (uniform density), world units
  double areaEstimate = 0.0;  // indirectly visible area, world units squared

  // since Lit
  // How far each VPL received photons, in units of its radius; 0: placed from the lights.
  double reach = 0.0;
  std::vector<Vec3> flux;
  std::vector<uint64_t> photons;
  std::vector<float> relativeError;
  uint32_t emitPoints = 1;  // of each row in the next two, one row's after the other's
  std::vector<Vec3> emitPosition, emitNormal;
  std::vector<Vec3> firstBounceFlux;

  std::vector<VplExtraColumn> extras;  // in the order in which they were added

  uint64_t sceneHash = 0;  // content hash of the scene that the rows lie on
  std::string provenance;  // JSON array, oldest stage first; see formats/README.md
  uint64_t checksum = 0;   // of the file that these rows were read from; 0 when they are new

  size_t size() const { return position.size(); }
};

// The given rows in the given order, with all their columns, a strategy's too, and with what the
// table says of them as a whole; the checksum is 0. Each of `rows` must be below table.size().
VplTable keepRows(const VplTable& table, std::span<const uint32_t> rows);

}  // namespace bnvpl
