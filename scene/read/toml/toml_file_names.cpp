#include "scene/read/toml/toml_file_names.h"

#include <cstdlib>

namespace bnvpl {

std::string FileNames::expand(const TomlSection& section, const char* key) const {
  const std::string text = section.fileName(key);
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const size_t end = text.compare(i, 2, "${") == 0 ? text.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      out += text[i++];
      continue;
    }
    const std::string name = text.substr(i + 2, end - i - 2);
    if (const std::string* given = defines_.find(name)) {
      out += *given;
    } else if (const char* value = std::getenv(name.c_str())) {
      out += value;
    } else {
      section.fail(section.node(key), "${" + name + "} is not set; pass --define " + name +
                                          "=FOLDER or set the environment variable " + name);
    }
    i = end + 1;
  }
  return out;
}

}  // namespace bnvpl
