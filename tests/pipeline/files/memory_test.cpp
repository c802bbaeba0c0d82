// More work takes more time, not more memory.
#include <nlohmann/json.hpp>

#include "tests/pipeline/tool_runner.h"
#include "tests/support/sanitizers.h"

namespace bnvpl {
namespace {

class Memory : public PipelineTest {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "sanitizers keep what is freed";
    makeStages(scene_);
  }
  // Each thread has its own buffers, and which of many threads get work is random; so two are used.
  double peakMiB(const std::string& name, const std::string& arguments) const {
    succeed(name, arguments + " --quiet --threads 2 --stats " + path("s.json"));
    return nlohmann::json::parse(readAll(at("s.json"))).at("peak_memory_MiB").get<double>();
  }
  // The limit is 2 MiB. Peaks differ by 0.2 MiB between runs; eight bytes leaked per photon are 2.3
  // MiB. On a busy machine an allocator occasionally keeps more, so three attempts are allowed.
  void expectSamePeak(const std::string& name, const std::string& few,
                      const std::string& many) const {
    const double least = peakMiB(name, few);
    double most = peakMiB(name, many);
    for (int again = 0; again < 2 && most - least >= 2.0; ++again) {
      most = std::min(most, peakMiB(name, many));
    }
    EXPECT_GT(least, 5.0) << name;
    EXPECT_LT(most - least, 2.0) << name << ": " << least << " MiB, then " << most;
  }
};

TEST_F(Memory, PhotonsLeaveNothingBehind) {
  for (const std::string scatter : {"guarded", "even"}) {
    const std::string command = scene_ + " " + path("vpls.vpl") + " -o " + path("l.vpl") +
                                " --method " + scatter + " --photons ";
    expectSamePeak("vpl-estimate", command + "20k", command + "320k");
  }
}

// The film holds up to 16 samples per pixel at once, so the comparison starts there.
TEST_F(Memory, SamplesLeaveNothingBehind) {
  for (const std::string& input :
       {path("lit.vpl"), path("lit.vpl") + " --gather lightcuts", std::string("--integrator path"),
        std::string("--integrator light")}) {
    const std::string command =
        scene_ + " " + input + " -o " + path("i.exr") + " --size 32x24 --spp ";
    expectSamePeak("vpl-render", command + "16", command + "128");
  }
}

TEST_F(Memory, ShardsLeaveNothingBehindInTheMerge) {
  const auto shards = [&](int of) {
    std::string all;
    for (int i = 1; i <= of; ++i) {
      const std::string part = std::to_string(i) + "/" + std::to_string(of);
      const std::string file = path(std::to_string(i) + "-" + std::to_string(of) + ".shard");
      succeed("vpl-render", scene_ + " --integrator light --size 64x48 --spp 4 --quiet --shard " +
                                part + " -o " + file);
      all += file + " ";
    }
    return all + "-o " + path("i.exr");
  };
  expectSamePeak("vpl-merge", shards(2), shards(60));
}

// Cells as small as these radii would each take a node of OpenVDB's tree, 34 kB, for one candidate.
TEST_F(Memory, TinyRadiiTakeNoMore) {
  succeed("vpl-place", scene_ + " -n 20k --quiet -o " + path("many.vpl"));
  const std::string command = path("many.vpl") + " -o " + path("few.vpl") + " --count 1000 --area ";
  EXPECT_LT(peakMiB("vpl-eliminate", command + "1e-9") - peakMiB("vpl-eliminate", command + "1"),
            60.0);
}

}  // namespace
}  // namespace bnvpl
