// Rows of stage Lit with several emission points.
#pragma once

#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// The same rows with `count` emission points each, 0.25 apart along x.
inline VplTable withEmitPoints(VplTable table, uint32_t count) {
  const VplTable one = table;
  table.emitPoints = count;
  table.emitPosition.clear();
  table.emitNormal.clear();
  for (size_t k = 0; k < one.size() * count; ++k) {
    table.emitPosition.push_back(one.emitPosition[k / count] +
                                 Vec3(0.25f * float(k % count), 0, 0));
    table.emitNormal.push_back(one.emitNormal[k / count]);
  }
  return table;
}

}  // namespace bnvpl
