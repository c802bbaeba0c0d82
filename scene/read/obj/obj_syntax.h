// Whether the lines of an OBJ that a mesh is made of say what they should.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bnvpl {

// What the numbers behind a keyword are. `problem` is empty or what is wrong, without the place.
struct NumbersOfLine {
  std::string problem;
  bool finite = true;  // false: one of those needed is nan or inf, in any spelling of C's
};

// The first `needed` words of `rest`, which must be there, and others up to `most`.
NumbersOfLine checkNumbers(std::string_view keyword, std::string_view rest, size_t needed,
                           size_t most);

struct CornersOfLine {
  std::string problem;
  size_t count = 0;
  size_t largest = 0;  // vertex, normal or coordinate; those that count back are not in it
};

// The corners of a face: 1, 1/2, 1//3 or 1/2/3, with or without slashes behind them.
CornersOfLine checkCorners(std::string_view rest);

// Of a word that is no number; names a decimal comma as such.
std::string noNumber(std::string_view word);
// A finite number, or nan or inf, which `finite` tells; false for everything else.
bool isNumber(std::string_view word, bool& finite);

}  // namespace bnvpl
