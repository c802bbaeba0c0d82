// Collects every file that a run reads or writes, so that none is overwritten by mistake.
//
//   RunFiles used;
//   used.reads("scene", path).writes("-o", output, {OutputKind::Lit}).writes(tool).check();
//   const Scene scene = loadScene(path);
//   used.ready(scene.files);
//   ... the work
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"
#include "tools/common/stage/output_kind.h"

namespace bnvpl {

struct ToolOptions;

class RunFiles {
 public:
  // `option` is the name that the user knows: "-o", "--mask", "scene". An empty path means that the
  // option was not given.
  RunFiles& reads(const std::string& option, const fs::path& file);

  // `kinds` lists what the file may hold. Its extension, in upper or lower case, selects one of
  // them; a name without extension allows all. Without kinds neither the name nor an existing file
  // is checked, as for a checkpoint, which is also read.
  RunFiles& writes(const std::string& option, const fs::path& file,
                   const std::vector<OutputKind>& kinds = {});
  RunFiles& writes(const ToolOptions& tool);  // --stats and --depfile; heeds --no-clobber
  // The tool whose shards an output of kind Shard may replace; unless called, the running one.
  RunFiles& shardsOf(const std::string& tool);

  // Call this first; it touches no file. Throws UsageError that names both options if an output is
  // also another output or an input, even through links or another spelling, and UsageError for an
  // extension of another kind. Throws OutputError if an output cannot be written, or exists
  // with --no-clobber.
  void check() const;

  // Call this just before the work, when the scene's files are known: check() with these as inputs,
  // then a trial write beside each output. Also throws OutputError if an output would replace a
  // file of another kind, and UsageError for names that a depfile cannot hold.
  void ready(const std::vector<fs::path>& sceneFiles = {});

 private:
  struct Named {
    std::string option;
    fs::path file;
    std::vector<OutputKind> kinds;  // for outputs only
  };
  void checkExtensions() const;
  bool mayReplaceBy(const fs::path& file, OutputKind kind) const;
  void checkKinds() const;
  void checkDepfileNames() const;
  void checkIdentities() const;
  void checkPartialNames() const;
  void checkNew() const;

  std::vector<Named> inputs_, outputs_;
  std::string shardTool_;
  bool noClobber_ = false;
};

}  // namespace bnvpl
