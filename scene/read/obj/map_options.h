// The options of an MTL's map_..., bump, disp, refl and norm.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

struct MapOptions {
  std::string kept;                  // -s, -o and -bm with all their values, each with a blank
  std::string name;                  // of the image; may hold blanks
  std::vector<std::string> ignored;  // others that would change the picture, with their values
  std::string problem;               // empty: none
};

// `rest` follows the key. Options stand before the name or behind it.
MapOptions mapOptions(std::string_view rest);

}  // namespace bnvpl
