// JSON of the tools, and the one way in which it becomes text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace bnvpl {

using Json = nlohmann::ordered_json;

// `indent` as of Json::dump(): -1 for one line. Names come from files and need not be UTF-8, which
// JSON is: U+FFFD takes the place of what is none. Never throws for a text.
std::string jsonText(const Json& json, int indent = -1);

// The same with every name, keys included, on its line: line breaks, other controls and what is no
// UTF-8 are escaped as escapedLine() does. For reports to people, which lay out lines of their own.
Json withEscapedNames(const Json& json);

}  // namespace bnvpl
