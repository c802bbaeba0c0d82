// What reader and writer share: where everything stands, and what may be in a file. Internal to
// vpl_opening.cpp, vpl_read.cpp and vpl_write.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/vpl_format.h"

namespace bnvpl {

// Bytes of one row over all columns.
uint64_t rowBytes(const std::vector<VplColumnView>& columns);

struct VplLayout {
  std::vector<VplColumnEntry> directory;
  uint64_t provenanceOffset = 0;
  uint64_t endMarkOffset = 0;
  uint64_t fileBytes = 0;
};

// Where a file with these columns has its parts; their values are not looked at. count * rowBytes()
// and provenanceBytes must each be at most 2^62, which the size of any real file is: then no sum
// overflows.
VplLayout makeLayout(const std::vector<VplColumnView>& columns, uint64_t count,
                     uint64_t provenanceBytes);
// The same of a file of the stage without columns of strategies.
VplLayout makeLayout(VplStage stage, uint64_t count, uint64_t provenanceBytes);

constexpr uint64_t alignUp(uint64_t offset) {
  return (offset + kVplAlign - 1) / kVplAlign * kVplAlign;
}

// Why a strategy's column must not stand behind `earlier` in a file: which field of its directory
// entry is wrong, and how. Its values are not looked at.
struct BadField {
  size_t offset;  // in VplColumnEntry
  std::string problem;
};
std::optional<BadField> findBadField(const VplExtraColumn& column,
                                     std::span<const VplExtraColumn> earlier);

// The first value, in file order, that has no business in a .vpl file.
struct BadValue {
  size_t column;  // in columnsOf(table)
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
