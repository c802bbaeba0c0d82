// No bias compensation: the light that the clamp removes and that of uncovered areas is missing.
#include "tools/render/compensate/compensate.h"

namespace bnvpl::methods::compensate::none {

namespace {

Compensation make(const CompensateInputs&, const Values&) { return {}; }

}  // namespace

extern const CompensateMethod method{
    "none", "no compensation: clamped light and that of uncovered areas is missing", {}, make};

}  // namespace bnvpl::methods::compensate::none
