// What the fuzz targets share. A target passes its input to a reader the way a tool does. Refusing
// it with the documented exception is right; everything else that stops the process is a finding:
// another exception, a sanitizer's report, a broken promise of the reader (require), a leak, too
// much memory or time.
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

// Ends the run with a finding unless what a reader promises of accepted input holds.
inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "PROMISE BROKEN: %s\n", promise);
  std::abort();
}

// False when the input was refused as documented: by a Refusal.
template <typename Refusal = InputError, typename Read>
bool accepted(const Read& read) {
  try {
    read();
  } catch (const Refusal&) {
    return false;
  }
  return true;
}

// The readers take file names. scripts/fuzz.sh points TMPDIR into memory and removes what is left.
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
