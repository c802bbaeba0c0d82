#include "tools/render/integrator/vpl_kind.h"

#include "core/errors.h"
#include "tools/render/integrator/integrator_method.h"

namespace bnvpl {

namespace {

constexpr OptionKey<std::string> kLightKey{"light"};

}  // namespace

VplKind vplKindOf(const Values& options) {
  return options.has(kLightKey) ? vplKindNamed(options[kLightKey]) : VplKind{};
}

void requireKindCompensated(const Values& options) {
  if (isFromCentre(vplKindOf(options))) return;
  const std::string& name = options[kLightKey];
  const CompensateMethod* compensate = compensationOf(options);
  if (compensate && compensate->oneSize)
    throw UsageError("--light " + name + " removes no light that --compensate " +
                     std::string(compensate->name) +
                     " could add back; choose another compensation or another light");
}

}  // namespace bnvpl
