#include "tools/common/run/build_id.h"

#include "bnvpl_build_id.h"  // made by cmake/build_id.cmake

namespace bnvpl {

std::string buildId() { return BNVPL_VERSION "+" BNVPL_BUILD_ID; }

std::string embreeVersion() { return BNVPL_EMBREE; }

}  // namespace bnvpl
