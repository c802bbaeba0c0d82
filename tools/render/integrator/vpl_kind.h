// The kind of virtual light of a run, and whether its compensation takes it.
#pragma once

#include "tools/common/options/option.h"
#include "transport/virtual_light/kinds.h"

namespace bnvpl {

// The default kind for methods without the option.
VplKind vplKindOf(const Values& options);
// Throws UsageError if the compensation cannot take the kind of light.
void requireKindCompensated(const Values& options);

}  // namespace bnvpl
