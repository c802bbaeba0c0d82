#pragma once

#include <string>

namespace bnvpl {

// Version and a hash of sources and compile options: "0.3.0+<12 hex digits>". A run does not
// resume checkpoints or merge shards of another build.
std::string buildId();

}  // namespace bnvpl
