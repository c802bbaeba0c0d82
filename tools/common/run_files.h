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
#include "tools/common/output_kind.h"

namespace bnvpl {

struct ToolOptions;

class RunFiles {
 public:
  // `option` as the user knows it: "-o", "--mask", "scene". An empty path is an option that was not
  // given.
  RunFiles& reads(const std::string& option, const fs::path& file);

  // `kinds` are what it may hold, of which the extension of its name, in upper case too, chooses
  // one; a name may also have none. None given: neither name nor an older file is looked at. A
  // checkpoint, which is read too, is one of these.
  RunFiles& writes(const std::string& option, const fs::path& file,
                   const std::vector<OutputKind>& kinds = {});
  RunFiles& writes(const ToolOptions& tool);  // --stats and --depfile

  // First of all: asks, and touches nothing. Throws UsageError, which names both options, when an
  // output is also another output or an input, be it through links or another spelling; and for an
  // extension of something else. Throws OutputError when an output cannot be written.
  void check() const;

  // Last before the work: check(), with the scene's own files as inputs, which are known only now;
  // then tries to write beside each output. Throws OutputError, too, where an output would replace
  // a file of another kind; and UsageError for names that a depfile cannot say.
  void ready(const std::vector<fs::path>& sceneFiles = {});

 private:
  struct Named {
    std::string option;
    fs::path file;
    std::vector<OutputKind> kinds;  // of outputs
  };
  void checkExtensions() const;
  void checkKinds() const;
  void checkDepfileNames() const;
  void checkIdentities() const;
  void checkPartialNames() const;

  std::vector<Named> inputs_, outputs_;
};

}  // namespace bnvpl
