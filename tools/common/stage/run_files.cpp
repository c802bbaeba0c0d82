#include "tools/common/stage/run_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "core/errors.h"
#include "core/files.h"
#include "formats/output_target.h"
#include "tools/common/files/depfile.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {
namespace {

// Identifies a file whatever the spelling of its path. A file that does not exist yet is a name in
// a folder.
struct Identity {
  uint64_t device = 0, inode = 0;
  std::string name;
  bool operator<(const Identity& o) const {
    return std::tie(device, inode, name) < std::tie(o.device, o.inode, o.name);
  }
};

Identity identityOf(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) == 0) return {info.st_dev, info.st_ino, ""};
  const fs::path target = followLinks(file);
  if (::stat(folderOf(target).c_str(), &info) == 0)
    return {info.st_dev, info.st_ino, target.filename().string()};
  std::error_code ignored;
  return {0, 0, fs::weakly_canonical(fs::absolute(target, ignored), ignored).string()};
}

std::string sceneFileName(const fs::path& file) {
  const std::string extension = lowerExtension(file);
  if (extension == ".toml" || extension == ".pbrt" || extension == ".gltf" || extension == ".glb")
    return "scene";
  if (extension == ".obj") return "a mesh of the scene";
  if (extension == ".mtl") return "a material library of the scene";
  return "an image of the scene";
}

bool mayBeNamed(const std::string& extension, OutputKind kind) {
  return extensionOf(kind).empty() || extensionOf(kind) == extension;
}

std::string quoted(const fs::path& file) { return "'" + file.string() + "'"; }

}  // namespace

RunFiles& RunFiles::reads(const std::string& option, const fs::path& file) {
  if (!file.empty()) inputs_.push_back({option, file, {}});
  return *this;
}

RunFiles& RunFiles::writes(const std::string& option, const fs::path& file,
                           const std::vector<OutputKind>& kinds) {
  if (!file.empty()) outputs_.push_back({option, file, kinds});
  return *this;
}

RunFiles& RunFiles::writes(const ToolOptions& tool) {
  noClobber_ = tool.noClobber;
  return writes("--stats", tool.stats, {OutputKind::Stats})
      .writes("--depfile", tool.depfile, {OutputKind::Depfile});
}

RunFiles& RunFiles::shardsOf(const std::string& tool) {
  shardTool_ = tool;
  return *this;
}

void RunFiles::checkExtensions() const {
  for (const Named& out : outputs_) {
    const std::string extension = lowerExtension(out.file);
    if (out.kinds.empty() || extension.empty() ||
        std::ranges::any_of(out.kinds, [&](OutputKind k) { return mayBeNamed(extension, k); }))
      continue;
    std::string contents, names;
    for (const OutputKind k : out.kinds) {
      const std::string separator = contents.empty() ? "" : " or ";
      contents += separator + contentOf(k);
      names += separator + out.file.filename().replace_extension(extensionOf(k)).string();
    }
    throw UsageError(out.option + " " + quoted(out.file) + " would hold " + contents +
                     ", not what its extension says; name it " + names);
  }
}

bool RunFiles::mayReplaceBy(const fs::path& file, OutputKind kind) const {
  if (!mayReplace(file, kind)) return false;
  const std::string maker = kind == OutputKind::Shard ? makerOfShard(file) : "";
  return maker.empty() || maker == (shardTool_.empty() ? runningTool() : shardTool_);
}

// An output may replace an existing file of its own kind only.
void RunFiles::checkKinds() const {
  for (const Named& out : outputs_) {
    const std::string extension = lowerExtension(out.file);
    std::string contents;
    bool replaces = out.kinds.empty();
    for (const OutputKind k : out.kinds) {
      if (!extension.empty() && !mayBeNamed(extension, k)) continue;
      contents += (contents.empty() ? "" : " or ") + contentOf(k);
      if (k == OutputKind::Shard)
        contents += " of " + (shardTool_.empty() ? runningTool() : shardTool_);
      replaces = replaces || mayReplaceBy(out.file, k);
    }
    if (replaces) continue;
    throw OutputError(out.file, "is not " + contents + ", which " + out.option +
                                    " would replace it with; name another file, or remove this "
                                    "one");
  }
}

void RunFiles::checkIdentities() const {
  std::map<Identity, const Named*> inputs, outputs;
  for (const Named& in : inputs_) inputs.emplace(identityOf(in.file), &in);
  for (const Named& out : outputs_) {
    std::error_code ignored;
    // replaceableTarget() refuses folders and devices.
    if (fs::exists(out.file, ignored) && !isRegularFile(out.file)) continue;
    const Identity identity = identityOf(out.file);
    if (const auto in = inputs.find(identity); in != inputs.end()) {
      throw UsageError(out.option + " " + quoted(out.file) + " and " + in->second->option + " " +
                       quoted(in->second->file) +
                       " are the same file, which the run reads; name another file for " +
                       out.option);
    }
    if (const auto [other, isNew] = outputs.emplace(identity, &out); !isNew) {
      throw UsageError(other->second->option + " " + quoted(other->second->file) + " and " +
                       out.option + " " + quoted(out.file) +
                       " are the same file; give each output a name of its own");
    }
  }
}

// An output removes partial files of unfinished runs, which it recognises by their names. No input
// may have such a name.
void RunFiles::checkPartialNames() const {
  for (const Named& in : inputs_) {
    std::error_code failed;
    const fs::path real = fs::canonical(in.file, failed);
    for (const Named& out : outputs_) {
      if (failed || !isPartialOf(real, out.file)) continue;
      throw UsageError(in.option + " " + quoted(in.file) + " is named as what an unfinished run " +
                       "leaves of " + out.option + " " + quoted(out.file) +
                       ", which the next one removes; rename it");
    }
  }
}

void RunFiles::checkDepfileNames() const {
  const bool asked = std::ranges::any_of(outputs_, [](const Named& out) {
    return std::ranges::find(out.kinds, OutputKind::Depfile) != out.kinds.end();
  });
  if (!asked) return;
  for (const Named& in : inputs_)  // scenes name most of them
    if (const std::string problem = depfileProblem(inDepfile(in.file)); !problem.empty())
      throw InputError(problem);
  for (const Named& out : outputs_)
    if (const std::string problem = depfileProblem(out.file); !problem.empty())
      throw UsageError(problem);
}

// A checkpoint, which has no kinds, is meant to be found.
void RunFiles::checkNew() const {
  for (const Named& out : outputs_) {
    if (!noClobber_ || out.kinds.empty() || !isRegularFile(out.file)) continue;
    throw OutputError(out.file, "exists, and --no-clobber keeps it; name another file for " +
                                    out.option + ", or remove this one");
  }
}

void RunFiles::check() const {
  checkIdentities();
  checkPartialNames();
  checkExtensions();
  checkNew();
  for (const Named& out : outputs_) replaceableTarget(out.file);
}

void RunFiles::ready(const std::vector<fs::path>& sceneFiles) {
  for (const fs::path& file : sceneFiles) reads(sceneFileName(file), file);
  check();
  checkKinds();
  checkDepfileNames();
  for (const Named& out : outputs_) requireWritable({out.file});
}

}  // namespace bnvpl
