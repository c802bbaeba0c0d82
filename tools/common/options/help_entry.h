// What --help and --help-json tell of one option.
#pragma once

#include <string>
#include <vector>

#include "tools/common/files/json_text.h"
#include "tools/common/options/option.h"

namespace bnvpl {

struct HelpEntry {
  // "kind", "unit", "range", "min", "max", "choices", "needs", "help"; "methods" of a method's
  // option: {"gather": ["lightcuts", "tilecuts"]}.
  Json facts;
  std::string brief;         // for --help: one line
  std::string full;          // for --help-all: one or several lines
  std::string briefDefault;  // the default that `brief` is about, if methods have different ones
};

// "COUNT", "on|off": the placeholder of the option's value.
std::string typeOf(const Option& option);
// "how far a VPL reaches for light (radii of the VPL, 0.01 to 100)"
std::string helpOf(const Option& option);

HelpEntry entryOf(const Option& option);
HelpEntry entryOf(const MethodSlot& slot);
// Entry of an option that is described by its help alone. `kind` is "file", "flag" or "text".
HelpEntry entryOf(const std::string& kind, const std::string& help);

// One option of several methods of a slot, which a command line has once.
struct SharedOption {
  std::vector<const Option*> options;
  std::vector<std::string> methods;  // which have them

  bool hasOneDefault() const;
  std::string methodNames() const;  // "lightcuts, tilecuts"
};
HelpEntry entryOf(const SharedOption& shared, const MethodSlot& slot);

}  // namespace bnvpl
