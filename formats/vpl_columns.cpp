#include "formats/vpl_io.h"
#include "formats/vpl_layout.h"

namespace bnvpl {

std::string_view stageName(VplStage stage) {
  switch (stage) {
    case VplStage::Candidates:
      return "candidates";
    case VplStage::Eliminated:
      return "eliminated";
    case VplStage::Lit:
      return "lit";
  }
  return "unknown";
}

std::string_view stageTool(VplStage stage) {
  switch (stage) {
    case VplStage::Candidates:
      return "vpl-place";
    case VplStage::Eliminated:
      return "vpl-eliminate";
    case VplStage::Lit:
      return "vpl-estimate";
  }
  return "unknown";
}

std::span<const VplColumnInfo> columnInfo(VplStage stage) {
  return std::span(kVplColumns).first(columnCount(stage));
}

double columnValue(const VplTable& table, size_t column, size_t row, size_t component) {
  switch (column) {
    case 0:
      return table.position[row][component];
    case 1:
      return table.normal[row][component];
    case 2:
      return table.albedo[row][component];
    case 3:
      return table.id[row];
    case 4:
      return table.radius[row];
    case 5:
      return table.flux[row][component];
    case 6:
      return static_cast<double>(table.photons[row]);
    case 7:
      return table.relativeError[row];
    case 8:
      return table.emitPosition[row][component];
    case 9:
      return table.emitNormal[row][component];
    default:
      return table.firstBounceFlux[row][component];
  }
}

}  // namespace bnvpl
