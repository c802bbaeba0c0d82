// The provenance of files: README.md, "Provenance".
#pragma once

#include <string>

namespace bnvpl {

// Max nesting depth of JSON values; bnvpl writes at most five levels. Programs that print JSON
// recurse for each level, and a file of brackets alone would overflow their stack.
inline constexpr int kMaxProvenanceDepth = 64;

// Whether `text` is a JSON array of objects in UTF-8, at most kMaxProvenanceDepth deep.
bool isProvenance(const std::string& text);

// The tool and method of the newest record, for messages: "vpl-place --method light". Empty if
// `text` is no provenance, or the record does not name a tool.
std::string makerOf(const std::string& text);

}  // namespace bnvpl
