#pragma once

#include <string>

namespace bnvpl {

// Version and a hash of the sources: "0.2.0+3f9c0a1b2c4d". The same for equal sources and compile
// options; what another build has begun is not gone on with.
std::string buildId();

}  // namespace bnvpl
