// Runs the built executables in a folder of the test's own.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

struct Outcome {
  int code = -1;  // 124: it ran for a minute and was stopped
  std::string out, err;
};

std::string readAll(const fs::path& file);
bool contains(const std::string& text, const std::string& part);

class PipelineTest : public ::testing::Test {
 protected:
  PipelineTest();
  ~PipelineTest() override;

  fs::path at(const std::string& name) const { return folder_ / name; }
  // Of a file in the test's folder, quoted for the shell.
  std::string path(const std::string& name) const { return "'" + at(name).string() + "'"; }
  void write(const std::string& name, const std::string& bytes) const;
  // What the folder holds, sorted; the files that the runner itself makes are left out.
  std::vector<std::string> listing() const;

  // A shell command, run from the project's root. `limits` goes before it, such as "ulimit -f 1;".
  Outcome shell(const std::string& command, const std::string& limits = "") const;
  // vpl-place and so on, with arguments for the shell.
  Outcome tool(const std::string& name, const std::string& arguments,
               const std::string& limits = "") const;
  // The same, expected to work in silence.
  void succeed(const std::string& name, const std::string& arguments) const;
  // The same, expected to fail with the code and one line on stderr that begins with the tool's
  // name and holds every part.
  void fail(const std::string& name, const std::string& arguments, int code,
            const std::vector<std::string>& parts = {}, const std::string& limits = "") const;

  // candidates.vpl, vpls.vpl and lit.vpl of a scene (quoted), in the test's folder; small and fast.
  void makeStages(const std::string& scene) const;
  // A copy of scenes/veach-door and the teapot with a film of 48 x 27; returns the scene.toml,
  // quoted.
  std::string copyVeachDoor() const;

  // 64 x 48 pixels, no textures.
  const std::string scene_;
  static const std::vector<std::string> kStages;

 private:
  fs::path folder_;
};

}  // namespace bnvpl
