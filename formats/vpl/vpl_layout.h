// The layout of .vpl files and the validity of their content, for reader and writer.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/hash.h"
#include "formats/vpl/vpl_format.h"

namespace bnvpl {

// Bytes of one row over all columns.
uint64_t rowBytes(const std::vector<VplColumnView>& columns);

struct VplLayout {
  std::vector<VplColumnEntry> directory;
  uint64_t provenanceOffset = 0;
  uint64_t endMarkOffset = 0;
  uint64_t fileBytes = 0;
};

// The layout of a file with these columns, regardless of their values. count * rowBytes() and
// provenanceBytes must each be at most 2^62, so that no sum overflows.
VplLayout makeLayout(const std::vector<VplColumnView>& columns, uint64_t count,
                     uint64_t provenanceBytes);
// The same for a file of the stage without extra columns.
VplLayout makeLayout(VplStage stage, uint64_t count, uint64_t provenanceBytes);

constexpr uint64_t alignUp(uint64_t offset) {
  return (offset + kVplAlign - 1) / kVplAlign * kVplAlign;
}

// The first invalid field in the directory entry of an extra column that follows the extra columns
// `earlier`. Its values are not checked.
struct BadField {
  size_t offset;  // offset in VplColumnEntry
  std::string problem;
};
std::optional<BadField> findBadField(const VplExtraColumn& column,
                                     std::span<const VplExtraColumn> earlier);

// The first invalid value in file order.
struct BadValue {
  size_t column;  // index into columnsOf(table)
  size_t row;
  std::string problem;
};
std::optional<BadValue> findBadValue(const VplTable& table);

// Whether a length or area is finite and not negative.
bool isMeasure(double value);
// Whether a share is 0 to 1.
constexpr bool isShare(double value) { return value >= 0.0 && value <= 1.0; }

}  // namespace bnvpl
