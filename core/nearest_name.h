// The name that a mistyped one was probably meant to be.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// Number of insertions, deletions, replacements and swaps of neighbouring letters that turn `a`
// into `b`, no letter being edited twice: the optimal string alignment of Damerau and Levenshtein.
size_t editDistance(std::string_view a, std::string_view b);

// The name with the smallest distance from `word`, the first of several; empty if more than two
// fifths of the letters differ.
std::string nearestName(std::string_view word, const std::vector<std::string>& names);

// The end of a message: "; did you mean NAME? Use one of a, b", with `before` put before the name.
// Without a near name only the cure: "; use one of a, b". An empty cure adds nothing.
std::string didYouMean(std::string_view word, const std::vector<std::string>& names,
                       const std::string& cure = "", std::string_view before = "");

}  // namespace bnvpl
