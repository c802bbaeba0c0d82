// Messages of exceptions.
#pragma once

#include <string>

namespace bnvpl {

// The message of the exception that `work` throws; empty when it throws none.
template <typename Exception, typename Work>
std::string messageOf(const Work& work) {
  try {
    work();
  } catch (const Exception& e) {
    return e.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
// Prints both on failure.
#define EXPECT_SAYS(text, part) EXPECT_PRED2(contains, std::string(text), std::string(part))

}  // namespace bnvpl
