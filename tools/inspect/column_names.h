// Names of the single numbers of a .vpl column.
#pragma once

#include <string>

#include "formats/vpl_format.h"

namespace bnvpl {

// "position.x", "flux.g", "radius".
inline std::string componentName(const VplColumnInfo& info, size_t component,
                                 char separator = '.') {
  std::string name(info.name);
  if (info.components == 1) return name;
  const bool colour = info.name == "albedo" || info.unit == "W";
  name += separator;
  name += (colour ? "rgb" : "xyz")[component];
  return name;
}

}  // namespace bnvpl
