#pragma once

#include <string>

namespace bnvpl {

// Version and a hash of sources, compile options and Embree's version: "0.3.0+<12 hex digits>". A
// run does not resume checkpoints or merge shards of another build.
std::string buildId();

// Version of the Embree that the build was made with: "3.13.5".
std::string embreeVersion();

}  // namespace bnvpl
