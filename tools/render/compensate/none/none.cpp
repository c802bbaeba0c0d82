// What the clamp and the gaps take away stays away.
#include "tools/render/compensate/compensate.h"

namespace bnvpl::methods::compensate::none {

namespace {

Compensation make(const CompensateInputs&, const Values&) { return {}; }

}  // namespace

extern const CompensateMethod method;
const CompensateMethod method{
    "none", "what the clamp and gaps between VPLs take stays away", {}, make};

}  // namespace bnvpl::methods::compensate::none
