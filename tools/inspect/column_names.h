// Names for the components of a .vpl column.
#pragma once

#include <string>

#include "formats/vpl/vpl_columns.h"

namespace bnvpl {

// "position.x", "flux.g", "radius", "emit_position.3.y". Components of a method's own columns are
// numbered: "rich.lobes.0".
inline std::string componentName(const VplColumnView& column, size_t component,
                                 char separator = '.') {
  std::string name(column.name);
  if (column.components == 1) return name;
  return name + separator +
         (column.parts.empty()
              ? std::to_string(component)
              : (column.components == column.parts.size()
                     ? std::string()
                     : std::to_string(component / column.parts.size()) + separator) +
                    column.parts[component % column.parts.size()]);
}

}  // namespace bnvpl
