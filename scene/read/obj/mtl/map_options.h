// Options of the MTL keys map_..., bump, disp, refl and norm.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

struct MapOptions {
  std::string kept;                  // -s, -o and -bm with all values, a blank behind each
  std::string name;                  // file of the image; may hold blanks
  std::vector<std::string> zeroed;   // options with a value that is not finite: "-s nan"
  std::vector<std::string> ignored;  // others that would affect the image, with their values
  std::string problem;               // empty if none
};

// Parses the text behind the key. Options stand before the name or behind it.
MapOptions mapOptions(std::string_view rest);

}  // namespace bnvpl
