// What reader and writer share: where everything stands, and which values are right. Internal to
// vpl_read.cpp and vpl_write.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/vpl_format.h"

namespace bnvpl {

// Columns that a file of the stage has: the first ones of kVplColumns.
size_t columnCount(VplStage stage);

// Bytes of one row over all columns of the stage.
uint64_t rowBytes(VplStage stage);

struct VplLayout {
  std::vector<VplColumnEntry> directory;
  uint64_t provenanceOffset = 0;
  uint64_t endMarkOffset = 0;
  uint64_t fileBytes = 0;
};

// Where a file of this shape has its parts. count * rowBytes(stage) and provenanceBytes must each
// be at most 2^62, which the size of any real file is: then no sum overflows.
VplLayout makeLayout(VplStage stage, uint64_t count, uint64_t provenanceBytes);

constexpr uint64_t alignUp(uint64_t offset) {
  return (offset + kVplAlign - 1) / kVplAlign * kVplAlign;
}

// Calls visit(column) with each column of the table that belongs to its stage, in file order.
// Table is VplTable or const VplTable.
template <typename Table, typename Visit>
void forEachColumn(Table& table, const Visit& visit) {
  visit(table.position);
  visit(table.normal);
  visit(table.albedo);
  visit(table.id);
  if (table.stage < VplStage::Eliminated) return;
  visit(table.radius);
  if (table.stage < VplStage::Lit) return;
  visit(table.flux);
  visit(table.photons);
  visit(table.relativeError);
  visit(table.emitPosition);
  visit(table.emitNormal);
  visit(table.firstBounceFlux);
}

// The first value, in file order, that has no business in a .vpl file.
struct BadValue {
  size_t column;  // in kVplColumns
  size_t row;
  std::string problem;
};
std::optional<BadValue> findBadValue(const VplTable& table);

using Bytes = std::span<const std::byte>;

template <typename T>
Bytes bytesOf(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

// XXH3-64 of the pieces put together.
uint64_t hashPieces(const std::vector<Bytes>& pieces);

// r_max and area: finite and not negative.
bool isMeasure(double value);

}  // namespace bnvpl
