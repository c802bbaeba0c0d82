// A stage's options on its command line, in its record and in its machine-readable help.
#pragma once

#include <string>

#include "tools/common/files/json_text.h"
#include "tools/common/options/cli_types.h"
#include "tools/common/options/option.h"

namespace bnvpl {

// Adds every option and slot of the stage, and --help-json. Typed values go to `given`, for
// resolve(). `spec` and `given` must outlive the parsing.
void addStageOptions(CLI::App& cli, const StageSpec& spec, Given& given);

// The values that determine the result, for the record and for a checkpoint's identity.
Json recordOf(const StageSpec& spec, const Values& values);

// The spec as JSON: {"tool": "vpl-render", "options": [...], "slots": [{"name": "gather",
// "methods": [{"name": "all", "summary": ..., "options": [...]}]}]}. The docs and the evaluation
// read it.
Json describeSpec(const StageSpec& spec);

}  // namespace bnvpl
