#pragma once

#include <string>

namespace bnvpl {

// Prints a warning about the result of the work, as one line on stderr. With --strict the tool
// still writes its outputs, which may have taken hours, and then ends with kExitInput.
void warnOfResult(const std::string& text);

}  // namespace bnvpl
