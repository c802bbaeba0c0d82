// Checks whether files form one complete chain: `vpl-inspect check --deep`.
#pragma once

#include "tools/inspect/check/check.h"

namespace bnvpl {

// How commands name the scene.
struct SceneWords {
  std::vector<std::string> scene{"SCENE"};  // a file, and options such as --define
  std::vector<std::string> view;            // options that only stages with a view take
};

// Stricter than checkTogether(). Throws InputError for
// - two files of one stage, or an input that is not among the files;
// - histories that do not continue each other, or that name several versions of the tools;
// - another scene or view, as checkScene() does, unless `scene` is null;
// - rows that differ from the input's: kept VPLs that are not candidates or whose flux differs by
//   more than a factor, lit VPLs that are not the kept ones or emit from points beyond their reach.
// The message ends with the commands that repair the chain, which name the scene by `words`.
void checkChain(std::span<const CheckedFile> files, const Scene* scene,
                const SceneWords& words = {});

// The command that a record describes: "vpl-eliminate a.vpl -o b.vpl --count 3000 ...".
std::string commandOf(const StageRecord& record, const std::vector<std::string>& inputs,
                      const fs::path& output);

}  // namespace bnvpl
