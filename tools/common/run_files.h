// Every file that a run reads or writes, under the name of its option: none is overwritten by
// mistake.
//
//   RunFiles used;
//   used.reads("scene", scenePath).writes("-o", output, {".vpl"}).writes(tool).check();
//   const Scene scene = loadScene(scenePath);
//   used.ready(scene.files);
//   ... the work
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

struct ToolOptions;

class RunFiles {
 public:
  // `option` as the user knows it: "-o", "--mask", "scene". An empty path is an option that was not
  // given.
  RunFiles& reads(const std::string& option, const fs::path& file);

  // `extensions`, which tell what it holds, are those that its name may have, in upper case too;
  // none given: any. A name may also have none. A checkpoint, which is read too, is one of these.
  RunFiles& writes(const std::string& option, const fs::path& file,
                   const std::vector<std::string>& extensions = {});
  RunFiles& writes(const ToolOptions& tool);  // --stats and --depfile

  // First of all: asks, and touches nothing. Throws UsageError, which names both options, when an
  // output is also another output or an input, be it through links or another spelling; and for an
  // extension of something else. Throws OutputError when an output cannot be written.
  void check() const;

  // Last before the work: check(), with the scene's own files as inputs, which are known only now;
  // then tries to write beside each output.
  void ready(const std::vector<fs::path>& sceneFiles = {});

 private:
  struct Named {
    std::string option;
    fs::path file;
    std::vector<std::string> extensions;  // of outputs
  };
  void checkExtensions() const;
  void checkIdentities() const;
  void checkPartialNames() const;

  std::vector<Named> inputs_, outputs_;
};

}  // namespace bnvpl
