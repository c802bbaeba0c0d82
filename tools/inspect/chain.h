// Whether files are one whole chain, from the first to the last: `vpl-inspect check --deep`.
#pragma once

#include "tools/inspect/check.h"

namespace bnvpl {

// Refuses, beyond what checkTogether() does: two files of one stage, an input that is not among the
// files, histories that do not continue each other or come from several versions of the tools,
// another scene or view (as checkScene(); null: not asked), and rows that are not the input's: kept
// VPLs that are no candidates, or whose flux was changed by more than a factor; lit VPLs that are
// others than the kept ones or moved beyond their reach. The message of the InputError ends with
// the commands that make the chain whole.
void checkChain(std::span<const CheckedFile> files, const Scene* scene);

// The command of a stage as its record tells it: "vpl-eliminate a.vpl -o b.vpl --count 3000 ...".
std::string commandOf(const StageRecord& record, const std::vector<std::string>& inputs,
                      const fs::path& output);

}  // namespace bnvpl
