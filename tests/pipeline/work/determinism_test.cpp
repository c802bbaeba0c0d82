// Every stage writes the same bytes for any number of threads.
#include "formats/image/exr_io.h"
#include "formats/vpl/vpl_io.h"
#include "tests/pipeline/tool_runner.h"

namespace bnvpl {
namespace {

class Determinism : public PipelineTest {
 protected:
  // The scene with glossy, mirror and textured surfaces, plus a light of every type.
  void SetUp() override {
    copyVeachDoor();
    write("veach-door/scene.toml",
          readAll(at("veach-door/scene.toml")) +
              "\n[[light]]\ntype = \"point\"\nposition = [0.5, 2.0, 2.0]\nintensity = [1, 1, 1]\n"
              "[[light]]\ntype = \"spot\"\nposition = [0.0, 2.0, 3.0]\ndirection = [0, -1, -0.5]\n"
              "intensity = [5, 4, 3]\ncone_deg = 40\nfalloff_deg = 10\n"
              "[[light]]\ntype = \"directional\"\ndirection = [0.2, -1, 0.1]\nirradiance = [3, 3, "
              "3]\n"
              "angular_diameter_deg = 2\n"
              "[[light]]\ntype = \"environment\"\nimage = \"landscape.png\"\n");
  }
  // Runs the command once for each number of threads; every listed output must be the same.
  void expectSame(const std::string& name, const std::string& arguments,
                  const std::vector<std::string>& outputs) const {
    std::vector<std::string> first;
    for (const char* threads : {"1", "2", "7"}) {
      succeed(name, arguments + " --threads " + threads);
      for (size_t i = 0; i < outputs.size(); ++i) {
        const std::string bytes = readAll(at(outputs[i]));
        ASSERT_GT(bytes.size(), 100u);
        if (threads[0] == '1') first.push_back(bytes);
        EXPECT_TRUE(bytes == first[i]) << outputs[i] << " differs with " << threads << " threads";
      }
    }
  }
  const std::string door_ = path("veach-door/scene.toml");
};

TEST_F(Determinism, EveryStageForAnyThreads) {
  expectSame("vpl-place", door_ + " -o " + path("c.vpl") + " -n 9k", {"c.vpl"});
  expectSame("vpl-eliminate", path("c.vpl") + " -o " + path("v.vpl") + " -n 700", {"v.vpl"});
  expectSame("vpl-estimate",
             door_ + " " + path("v.vpl") + " -o " + path("l.vpl") + " --photons 60k", {"l.vpl"});
  expectSame("vpl-render",
             door_ + " " + path("l.vpl") + " -o " + path("i.exr") + " --spp 2 --layers all --png " +
                 path("i.png"),
             {"i.exr", "i.png"});
}

TEST_F(Determinism, OtherMethodsForAnyThreads) {
  expectSame("vpl-place", door_ + " -o " + path("c.vpl") + " -n 3k --depth 5", {"c.vpl"});
  for (const char* options : {"--method random", "--density uniform"}) {
    expectSame("vpl-eliminate", path("c.vpl") + " -o " + path("v.vpl") + " -n 300 " + options,
               {"v.vpl"});
  }
  expectSame("vpl-estimate",
             door_ + " " + path("v.vpl") + " -o " + path("l.vpl") + " --photons 20k --method even",
             {"l.vpl"});
  expectSame(
      "vpl-render",
      door_ + " " + path("l.vpl") + " -o " + path("i.exr") + " --spp 1 --gather all --pixels half",
      {"i.exr"});
}

TEST_F(Determinism, LightPlacementAndReferencesForAnyThreads) {
  expectSame("vpl-place", door_ + " -o " + path("l.vpl") + " -n 2k --method light", {"l.vpl"});
  expectSame("vpl-render", door_ + " " + path("l.vpl") + " -o " + path("i.exr") + " --spp 1",
             {"i.exr"});
  for (const std::string integrator : {"path", "light"}) {
    expectSame("vpl-render",
               door_ + " -o " + path("p.exr") + " --spp 4 --layers direct,indirect --integrator " +
                   integrator,
               {"p.exr"});
  }
}

// Without this test, a program that ignores the seed would pass those above. Files of two seeds
// differ anyway, by their records, and so their contents are compared.
TEST_F(Determinism, AnotherSeedHasOtherContents) {
  const auto contents = [&](const std::string& file) {
    if (file.ends_with("vpl-render")) return *readExr(at(file)).find("R");
    const VplTable table = readVpl(at(file));
    std::vector<float> values;
    for (const Vec3 p : table.position) values.push_back(p.x);
    for (const Vec3 f : table.flux) values.push_back(f.x);
    return values;
  };
  const auto pair = [&](const std::string& name, const std::string& arguments) {
    const std::string a = "a-" + name, b = "b-" + name;
    succeed(name, arguments + " -o " + path(a) + " --seed 1");
    succeed(name, arguments + " -o " + path(b) + " --seed 2");
    EXPECT_NE(contents(a), contents(b)) << name;
  };
  pair("vpl-place", door_ + " -n 500");
  makeStages(door_);
  pair("vpl-eliminate", path("candidates.vpl") + " -n 50 --method random");
  pair("vpl-estimate", door_ + " " + path("vpls.vpl") + " --photons 1k");
  pair("vpl-render", door_ + " " + path("lit.vpl") + " --spp 1");
}

// Neither the folder nor the date gets into a file.
TEST_F(Determinism, FilesDoNotDependOnTheFolder) {
  makeStages(door_);
  fs::rename(at("veach-door"), at("moved"));
  fs::create_directories(at("elsewhere"));
  const std::string moved = path("moved/scene.toml");
  succeed("vpl-place", moved + " -o " + path("elsewhere/c") + " -n 300");
  succeed("vpl-eliminate", path("elsewhere/c") + " -o " + path("elsewhere/v") + " -n 60");
  succeed("vpl-estimate",
          moved + " " + path("elsewhere/v") + " -o " + path("elsewhere/l") + " --photons 2k");
  EXPECT_TRUE(readAll(at("candidates.vpl")) == readAll(at("elsewhere/c")));
  EXPECT_TRUE(readAll(at("vpls.vpl")) == readAll(at("elsewhere/v")));
  EXPECT_TRUE(readAll(at("lit.vpl")) == readAll(at("elsewhere/l")));
}

}  // namespace
}  // namespace bnvpl
