// The history that files carry, as text: README.md, "Provenance".
#pragma once

#include <string>

namespace bnvpl {

// Values inside values; ours are five deep. Programs that print JSON call themselves once a level,
// and a file of nothing but brackets would overflow their stack.
inline constexpr int kMaxProvenanceDepth = 64;

// Whether `text` is a JSON array of objects, in UTF-8, at most kMaxProvenanceDepth deep.
bool isProvenance(const std::string& text);

// The tool of the newest record and its method, for messages: "vpl-place --method light". Empty
// when `text` is no provenance or the record does not tell, in plain words.
std::string makerOf(const std::string& text);

}  // namespace bnvpl
