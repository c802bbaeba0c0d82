#include "tools/common/files/json_text.h"

#include "tools/common/files/escape_text.h"

namespace bnvpl {

std::string jsonText(const Json& json, int indent) {
  return json.dump(indent, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
}

Json parseJson(const std::string& text) {
  return Json::parse(text, nullptr, /*allow_exceptions=*/false);
}

Json withEscapedNames(const Json& json) {
  if (json.is_string()) return escapedLine(json.get_ref<const std::string&>());
  if (!json.is_structured()) return json;
  Json safe = json.is_array() ? Json::array() : Json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array())
      safe.push_back(withEscapedNames(value));
    else
      safe[escapedLine(key)] = withEscapedNames(value);
  }
  return safe;
}

}  // namespace bnvpl
