// Shared by the fuzz targets. A target passes its input to a reader as a tool does. The reader may
// refuse it with the documented exception. Anything else that stops the process is a finding:
// another exception, a sanitizer's report, a violated postcondition of the reader (require), a
// leak, or too much memory or time.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "core/errors.h"

namespace bnvpl {

// Ends the run with a finding if a postcondition of a reader does not hold for accepted input.
inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "PROMISE BROKEN: %s\n", promise);
  std::abort();
}

// Returns false if the reader refused the input with the documented exception, Refusal.
template <typename Refusal = InputError, typename Read>
bool accepted(const Read& read) {
  try {
    read();
  } catch (const Refusal&) {
    return false;
  }
  return true;
}

// A folder for the files that readers open. scripts/fuzz.sh sets TMPDIR to a folder in memory, and
// removes it.
class InputFolder {
 public:
  InputFolder() : folder_(fs::temp_directory_path() / ("fuzz-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  fs::path at(std::string_view name) const { return folder_ / name; }
  fs::path write(std::string_view name, std::string_view bytes) const {
    std::ofstream out(at(name), std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    require(out.good(), "the fuzzer can write its own input");
    return at(name);
  }
  std::string read(std::string_view name) const {
    std::ifstream in(at(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  fs::path folder_;
};

}  // namespace bnvpl
