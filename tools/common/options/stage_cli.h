// A stage's options on its command line and in its record.
#pragma once

#include <string>

#include "tools/common/files/json_text.h"
#include "tools/common/options/cli_types.h"
#include "tools/common/options/option.h"

namespace bnvpl {

// Adds every option and slot of the stage, with their help and examples. Typed values go to
// `given`, for resolve(). `spec` and `given` must outlive the parsing.
void addStageOptions(CLI::App& cli, const StageSpec& spec, Given& given);

// The values that determine the result, for the record and for a checkpoint's identity.
Json recordOf(const StageSpec& spec, const Values& values);

}  // namespace bnvpl
