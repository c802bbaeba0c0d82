// Names of the single numbers of a .vpl column.
#pragma once

#include <string>

#include "formats/vpl_columns.h"

namespace bnvpl {

// "position.x", "flux.g", "radius"; a strategy's columns are numbered: "rich.lobes.0".
inline std::string componentName(const VplColumnView& column, size_t component,
                                 char separator = '.') {
  std::string name(column.name);
  if (column.components == 1) return name;
  return name + separator +
         (column.parts.empty() ? std::to_string(component)
                               : std::string(1, column.parts[component]));
}

}  // namespace bnvpl
