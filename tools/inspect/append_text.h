// Appends printf output to a text.
#pragma once

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string>

namespace bnvpl {

// The output may have any length.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
inline void
append(std::string& text, const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const auto length =
      static_cast<size_t>(std::max(0, std::vsnprintf(nullptr, 0, format, arguments)));
  const size_t end = text.size();
  text.resize(end + length + 1);  // including the terminating zero
  std::vsnprintf(text.data() + end, length + 1, format, again);
  text.resize(end + length);
  va_end(again);
  va_end(arguments);
}

}  // namespace bnvpl
