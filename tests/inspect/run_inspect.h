// Runs the executable itself.
#pragma once

#include <sys/wait.h>

#include <cmath>
#include <cstdio>

#include "tests/inspect/inspect_files.h"

namespace bnvpl {

struct Outcome {
  int code = -1;
  std::string output;  // stdout and stderr
};

inline Outcome runInspect(const std::string& arguments) {
  Outcome result;
  FILE* pipe = ::popen(("'" BNVPL_INSPECT "' " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return result;
  char buffer[4096];
  for (size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    result.output.append(buffer, n);
  const int status = ::pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace bnvpl
