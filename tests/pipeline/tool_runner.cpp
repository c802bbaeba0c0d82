#include "tests/pipeline/tool_runner.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tools/common/process/exit_codes.h"

namespace bnvpl {

const std::vector<std::string> PipelineTest::kStages{"vpl-place", "vpl-eliminate", "vpl-estimate",
                                                     "vpl-render"};

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

PipelineTest::PipelineTest()
    : scene_("'" BNVPL_SOURCE "/scenes/test/one-bounce.toml'"),
      folder_(fs::temp_directory_path() / ("bnvpl-pipeline-" + std::to_string(::getpid()))) {
  fs::create_directories(folder_);
}
PipelineTest::~PipelineTest() { fs::remove_all(folder_); }

void PipelineTest::write(const std::string& name, const std::string& bytes) const {
  fs::create_directories(at(name).parent_path());
  std::ofstream out(at(name), std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.good()) << name;
}

std::vector<std::string> PipelineTest::listing() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.path().filename() != ".out" && entry.path().filename() != ".err") {
      names.push_back(entry.path().lexically_relative(folder_).string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

Outcome PipelineTest::shell(const std::string& command, const std::string& limits) const {
  const std::string whole = "cd '" BNVPL_SOURCE "'; { " + limits + " timeout 60 " + command +
                            "; } >" + path(".out") + " 2>" + path(".err");
  const int status = std::system(whole.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readAll(at(".out")), readAll(at(".err"))};
}

Outcome PipelineTest::tool(const std::string& name, const std::string& arguments,
                           const std::string& limits) const {
  return shell("'" BNVPL_BIN "/" + name + "' " + arguments, limits);
}

void PipelineTest::interrupt(const std::string& name, const std::string& arguments,
                             const std::string& checkpoint, double seconds) const {
  for (const double delay : {seconds, 4 * seconds, 12 * seconds, 36 * seconds}) {
    if (fs::exists(at(checkpoint))) break;
    shell("timeout --foreground -s INT " + std::to_string(delay) + " '" BNVPL_BIN "/" + name +
          "' " + arguments);
  }
  ASSERT_TRUE(fs::exists(at(checkpoint)));
}

void PipelineTest::succeed(const std::string& name, const std::string& arguments) const {
  const Outcome r = tool(name, arguments);
  ASSERT_EQ(r.code, kExitOk) << name << " " << arguments << "\n" << r.err;
}

void PipelineTest::fail(const std::string& name, const std::string& arguments, int code,
                        const std::vector<std::string>& parts, const std::string& limits) const {
  const Outcome r = tool(name, arguments, limits);
  const std::string what = name + " " + arguments + "\n" + r.err;
  EXPECT_EQ(r.code, code) << what;
  EXPECT_EQ(r.out, "") << what;
  EXPECT_EQ(r.err.rfind(name + ": ", 0), 0u) << what;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << what;
  EXPECT_TRUE(!r.err.empty() && r.err.back() == '\n') << what;
  EXPECT_FALSE(contains(r.err, "internal error")) << what;
  for (const std::string& part : parts)
    EXPECT_TRUE(contains(r.err, part)) << "no '" << part << "' in: " << what;
}

void PipelineTest::makeStages(const std::string& scene) const {
  succeed("vpl-place", scene + " -o " + path("candidates.vpl") + " -n 300");
  succeed("vpl-eliminate", path("candidates.vpl") + " -o " + path("vpls.vpl") + " -n 60");
  succeed("vpl-estimate",
          scene + " " + path("vpls.vpl") + " -o " + path("lit.vpl") + " --photons 2k");
}

std::string PipelineTest::copyVeachDoor() const {
  for (const char* name : {"veach-door", "teapot"}) {
    fs::copy(fs::path(BNVPL_SOURCE "/scenes") / name, at(name), fs::copy_options::recursive);
  }
  std::string toml = readAll(at("veach-door/scene.toml"));
  for (const auto& [from, to] :
       {std::pair{"width = 640", "width = 48"}, std::pair{"height = 360", "height = 27"}}) {
    const size_t where = toml.find(from);
    EXPECT_NE(where, std::string::npos) << from;
    toml.replace(where, std::string(from).size(), to);
  }
  write("veach-door/scene.toml", toml);
  return path("veach-door/scene.toml");
}

}  // namespace bnvpl
