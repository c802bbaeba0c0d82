// Runs the built executables in a temporary folder of the test.
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
  // Path of a file in the test's folder, quoted for the shell.
  std::string path(const std::string& name) const { return "'" + at(name).string() + "'"; }
  void write(const std::string& name, const std::string& bytes) const;
  // Names of the files in the folder, sorted, without those that the runner itself makes.
  std::vector<std::string> listing() const;

  // Runs a shell command from the project's root. `limits` goes before it, such as "ulimit -f 1;".
  Outcome shell(const std::string& command, const std::string& limits = "") const;
  // Runs a tool such as vpl-place with arguments for the shell.
  Outcome tool(const std::string& name, const std::string& arguments,
               const std::string& limits = "") const;
  // Runs the tool and expects success.
  void succeed(const std::string& name, const std::string& arguments) const;
  // Runs the tool and expects the exit code and one line on stderr that begins with the tool's name
  // and holds every part.
  void fail(const std::string& name, const std::string& arguments, int code,
            const std::vector<std::string>& parts = {}, const std::string& limits = "") const;
  // Interrupts a run of the tool that would take very long, so that its checkpoint remains: after
  // `seconds` or, as a busy machine may take long to begin, later.
  void interrupt(const std::string& name, const std::string& arguments,
                 const std::string& checkpoint, double seconds = 0.5) const;

  // Makes small candidates.vpl, vpls.vpl and lit.vpl of a scene (quoted) in the test's folder.
  void makeStages(const std::string& scene) const;
  // Copies scenes/veach-door and the teapot with a film of 48 x 27; returns its scene.toml, quoted.
  std::string copyVeachDoor() const;

  // A scene of 64 x 48 pixels without textures.
  const std::string scene_;
  static const std::vector<std::string> kStages;

 private:
  fs::path folder_;
};

}  // namespace bnvpl
