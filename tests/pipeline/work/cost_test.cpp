// --estimate predicts what a stage will need; the prediction is compared with the actual run.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/pipeline/tool_runner.h"
#include "tests/support/sanitizers.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using Json = nlohmann::json;

class CostRun : public PipelineTest {
 protected:
  struct Need {
    double cpuS, memoryMiB;
  };
  Need estimated(const std::string& name, const std::string& arguments) const {
    const std::vector<std::string> files = listing();
    const Outcome r = tool(name, arguments + " --estimate --json");
    EXPECT_EQ(r.code, kExitOk) << r.err;
    EXPECT_EQ(listing(), files) << name << " wrote a file";
    const Json json = Json::parse(r.out, nullptr, false);
    if (!json.is_object()) return {0, 0};
    EXPECT_EQ(json["tool"], name);
    EXPECT_LE(json["setup_cpu_s"], json["cpu_s"]);
    return {json["cpu_s"], json["memory_MiB"]};
  }
  // CPU time of all threads as counted by the kernel; load of the machine hardly matters.
  Need taken(const std::string& name, const std::string& arguments) const {
    const Outcome r = shell(
        "python3 -c 'import resource, subprocess, sys; "
        "used = lambda: resource.getrusage(resource.RUSAGE_CHILDREN); "
        "before = used(); "  // a wrapper that started Python may have used some
        "code = subprocess.call(sys.argv[1:]); "
        "use = used(); "
        "print(use.ru_utime + use.ru_stime - before.ru_utime - before.ru_stime, "
        "use.ru_maxrss / 1024); sys.exit(code)' '" BNVPL_BIN "/" +
        name + "' " + arguments + " --quiet");
    EXPECT_EQ(r.code, kExitOk) << r.err;
    const size_t before = r.out.empty() ? 0 : r.out.rfind('\n', r.out.size() - 2);
    std::istringstream text(before == std::string::npos ? r.out : r.out.substr(before + 1));
    Need need{};
    text >> need.cpuS >> need.memoryMiB;
    return need;
  }
  void expectPredicted(const std::string& name, const std::string& arguments) const {
    Need told{}, took{};
    // What else a machine does slows the trial or the run: the first of three that agree counts.
    for (int run = 0; run < 3; ++run) {
      told = estimated(name, arguments), took = taken(name, arguments);
      if (told.cpuS < 2.0 * took.cpuS && told.cpuS > 0.5 * took.cpuS) break;
    }
    const std::string what = name + ": told " + std::to_string(told.cpuS) + " s, " +
                             std::to_string(told.memoryMiB) + " MiB; took " +
                             std::to_string(took.cpuS) + " s, " + std::to_string(took.memoryMiB) +
                             " MiB";
    RecordProperty(name, what);
    EXPECT_LT(told.cpuS, 2.0 * took.cpuS) << what;
    EXPECT_GT(told.cpuS, 0.5 * took.cpuS) << what;
    EXPECT_LT(told.memoryMiB, 1.5 * took.memoryMiB) << what;
    EXPECT_GT(told.memoryMiB, took.memoryMiB / 1.5) << what;
  }
  // Each run is so long that its trial is only a part of it.
  void expectAllPredicted(const std::string& scene) const {
    expectPredicted("vpl-place", scene + " -n 100k -o " + path("candidates.vpl"));
    expectPredicted("vpl-eliminate", path("candidates.vpl") + " -n 10k -o " + path("vpls.vpl"));
    expectPredicted("vpl-estimate",
                    scene + " " + path("vpls.vpl") + " --photons 500k -o " + path("lit.vpl"));
    expectPredicted("vpl-render",
                    scene + " " + path("lit.vpl") + " --size 128x96 --spp 4 -o " + path("i.exr"));
  }
};

TEST_F(CostRun, StagesTakeWhatTheyPredictInTheUShape) {
  expectAllPredicted("'" BNVPL_SOURCE "/scenes/u-shape/scene.toml'");
}

TEST_F(CostRun, StagesTakeWhatTheyPredictInACornellBox) {
  expectAllPredicted("'" BNVPL_SOURCE "/scenes/cornell/scene.toml'");
}

TEST_F(CostRun, MemoryOfLightGroupsIsPredicted) {
  std::string lights;
  for (const char* name : {"key", "fill", "rim"}) {
    lights += "\n[[light]]\ntype = \"point\"\nposition = [0.1, 0.3, 0.1]\npower = [1, 1, 1]\n" +
              std::string("group = \"") + name + "\"\n";
  }
  write("groups.toml", "[[mesh]]\nfile = " + scene_ + lights);
  const std::string render = path("groups.toml") +
                             " --integrator path --size 640x480 --passes 2 --pass-spp 1 -o " +
                             path("x.exr") + " --layers light_groups";
  const double told = estimated("vpl-render", render).memoryMiB,
               took = taken("vpl-render", render).memoryMiB;
  EXPECT_LT(told, 1.25 * took);
  EXPECT_GT(told, took / 1.25);
}

TEST_F(CostRun, ShardsTakeTheirPart) {
  const std::string render = scene_ + " --integrator path --size 192x144 --spp 256 -o ";
  const Need whole = estimated("vpl-render", render + path("x.exr"));
  const Need tenth = estimated("vpl-render", render + path("x.shard") + " --shard 3/10");
  EXPECT_LT(tenth.cpuS, 0.3 * whole.cpuS);
  EXPECT_GT(tenth.cpuS, 0.03 * whole.cpuS);
}

// These runs would never end in practice. The limit is on CPU seconds of the estimate itself, which
// load hardly changes.
TEST_F(CostRun, EndsInSecondsWhateverIsAsked) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take several times as long";
  makeStages(scene_);
  const std::string vpls = scene_ + " " + path("vpls.vpl") + " -o " + path("x.vpl"),
                    lit = scene_ + " " + path("lit.vpl"), image = " -o " + path("x.exr");
  for (const auto& [name, arguments] : std::initializer_list<std::pair<std::string, std::string>>{
           {"vpl-place", scene_ + " -n 2G -o " + path("x.vpl")},
           {"vpl-estimate", vpls + " --photons 1G"},
           {"vpl-estimate", vpls + " --photons 60G --irradiance-error 0"},
           {"vpl-estimate", vpls + " --method guarded --photons 60G"},
           {"vpl-estimate", vpls + " --method paths --points 1M --paths 1M"},
           {"vpl-render", lit + image + " --spp 1M"},
           {"vpl-render", lit + image + " --size 16384x16384 --caustic-photons 4096"},
           {"vpl-render", lit + image + " --integrator guided --spp 1M --guide-rays 1024"},
           {"vpl-render", scene_ + image + " --integrator path --size 16384x16384 --spp 1M"},
           {"vpl-render", scene_ + image + " --integrator light --spp 1M"}}) {
    const Need trial = taken(name, arguments + " --estimate");
    EXPECT_LT(trial.cpuS, 30.0) << name << " " << arguments;
  }
}

// The predicted cost grows with the work, including preparations that a trial does only in part.
TEST_F(CostRun, GrowsWithWhatIsAskedFor) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take several times as long";
  makeStages(scene_);
  const std::string vpls = scene_ + " " + path("vpls.vpl") + " -o " + path("x.vpl"),
                    lit = scene_ + " " + path("lit.vpl") + " -o " + path("x.exr");
  const auto grows = [&](const std::string& name, const std::string& few, const std::string& many,
                         double times) {
    const auto cpuS = [&](const std::string& arguments, size_t trials) {
      std::vector<double> s;
      while (s.size() < trials) s.push_back(estimated(name, arguments).cpuS);
      std::ranges::sort(s);
      return s[trials / 2];
    };
    double a = cpuS(few, 1), b = cpuS(many, 1);
    // Where the machine may have disturbed a trial, the median of three decides.
    if (b <= times / 1.6 * a || b >= times * 1.6 * a) a = cpuS(few, 3), b = cpuS(many, 3);
    EXPECT_GT(b, times / 1.6 * a) << many;
    EXPECT_LT(b, times * 1.6 * a) << many;
  };
  const std::string all = vpls + " --irradiance-error 0 --photons ";
  grows("vpl-estimate", all + "10M", all + "1G", 100.0);
  grows("vpl-render", lit + " --integrator guided --size 64x48 --spp 256",
        lit + " --integrator guided --size 64x48 --spp 4096", 16.0);
  grows("vpl-render", lit + " --size 2000x1500 --spp 64", lit + " --size 4000x3000 --spp 64", 4.0);
}

TEST_F(CostRun, OneLinePrintsIt) {
  const Outcome r = tool("vpl-place", scene_ + " -n 2k --estimate -o " + path("x.vpl"));
  EXPECT_EQ(r.code, kExitOk) << r.err;
  EXPECT_EQ(r.out.rfind("vpl-place: about ", 0), 0u) << r.out;
  EXPECT_TRUE(contains(r.out, " MiB of memory and ") && contains(r.out, " CPU seconds")) << r.out;
  EXPECT_EQ(std::count(r.out.begin(), r.out.end(), '\n'), 1);
  fail("vpl-place", scene_ + " --json -o " + path("x.vpl"), kExitUsage, {"--json", "--estimate"});
  const std::string render =
      scene_ + " --integrator path --size 32x24 --estimate -o " + path("x.exr");
  fail("vpl-render", render + " --time 2s", kExitUsage, {"--estimate", "give --passes"});
  EXPECT_EQ(tool("vpl-render", render + " --passes 3").code, kExitOk);
  EXPECT_FALSE(fs::exists(at("x.vpl")) || fs::exists(at("x.exr")));
}

}  // namespace
}  // namespace bnvpl
