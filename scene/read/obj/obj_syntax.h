// Checks the syntax of the OBJ lines that form a mesh.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bnvpl {

// The numbers behind a keyword. `problem` is empty or a message without the place.
struct NumbersOfLine {
  std::string problem;
  bool finite = true;  // false if a number is nan or inf, in any spelling of C
};

// Checks the first `most` words of `rest`, of which `needed` must exist.
NumbersOfLine checkNumbers(std::string_view keyword, std::string_view rest, size_t needed,
                           size_t most);

struct CornersOfLine {
  std::string problem;
  size_t count = 0;
  size_t largest = 0;  // largest index; of relative ones, only those beyond int count
};

// Checks the corners of a face: 1, 1/2, 1//3 or 1/2/3; slashes may follow.
CornersOfLine checkCorners(std::string_view rest);

// The message about a word that is no number; it points out a decimal comma.
std::string noNumber(std::string_view word);
// Whether a word is a number; `finite` becomes false for nan and inf.
bool isNumber(std::string_view word, bool& finite);

}  // namespace bnvpl
