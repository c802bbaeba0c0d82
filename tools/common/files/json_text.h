// The JSON type of the tools, and its serialization.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace bnvpl {

using Json = nlohmann::ordered_json;

// Serializes to UTF-8; `indent` is that of Json::dump(), -1 for one line. Names from files need not
// be UTF-8: U+FFFD replaces invalid bytes, and no text makes this throw.
std::string jsonText(const Json& json, int indent = -1);

// The JSON of a text; is_discarded() if the text is none. The parser takes seconds to compile in
// each source that instantiates it.
Json parseJson(const std::string& text);

// A copy with escapedLine() applied to every string and key, for reports to people, which lay out
// their own lines.
Json withEscapedNames(const Json& json);

}  // namespace bnvpl
