// printf to the end of a text.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace bnvpl {

// Up to 511 characters.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
inline void
append(std::string& text, const char* format, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

}  // namespace bnvpl
