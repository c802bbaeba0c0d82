// .vpl files between the executables: extra columns, other versions, and the maker of a file.
#include "formats/vpl/vpl_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class VplFiles : public PipelineTest {
 protected:
  void SetUp() override { makeStages(scene_); }
  // Copies a file and adds a column that no tool knows.
  void addLobes(const std::string& from, const std::string& to) const {
    VplTable table = readVpl(at(from));
    std::vector<float> lobes;
    for (const uint32_t id : table.id) {
      for (const float offset : {0.0f, 0.25f}) lobes.push_back(static_cast<float>(id) + offset);
    }
    table.extras.push_back({"rich.lobes", "1", 2, lobes});
    writeVpl(at(to), table);
  }
  // Each row still has the values that belong to its id.
  void expectLobes(const std::string& name) const {
    const VplTable table = readVpl(at(name));
    ASSERT_EQ(table.extras.size(), 1u) << name;
    EXPECT_EQ(table.extras[0].name, "rich.lobes");
    const auto& lobes = std::get<std::vector<float>>(table.extras[0].values);
    ASSERT_EQ(lobes.size(), 2 * table.size());
    for (size_t row = 0; row < table.size(); ++row) {
      EXPECT_EQ(lobes[2 * row], static_cast<float>(table.id[row]));
      EXPECT_EQ(lobes[2 * row + 1], static_cast<float>(table.id[row]) + 0.25f);
    }
  }
};

TEST_F(VplFiles, ColumnsOfMethodsSurviveTheStages) {
  addLobes("vpls.vpl", "v.vpl");
  succeed("vpl-estimate", scene_ + " " + path("v.vpl") + " -o " + path("l.vpl") + " --photons 5k");
  expectLobes("l.vpl");
  const Outcome info = tool("vpl-inspect", "info " + path("l.vpl"));
  EXPECT_TRUE(
      contains(info.out, "\ncolumns of methods, which all stages keep: rich.lobes (f32 x 2)\n"))
      << info.out;
  succeed("vpl-render", scene_ + " " + path("l.vpl") + " -o " + path("i.exr") + " --spp 1");
  EXPECT_EQ(tool("vpl-inspect", "check " + path("v.vpl") + " " + path("l.vpl")).code, kExitOk);
  EXPECT_EQ(tool("vpl-inspect", "export " + path("l.vpl") + " -o " + path("l.csv")).code, kExitOk);
  EXPECT_TRUE(contains(readAll(at("l.csv")), ",rich.lobes_0,rich.lobes_1\n"));
}

// Extra columns do not change what the stages compute.
TEST_F(VplFiles, ColumnsOfMethodsLeaveTheOthersAlone) {
  addLobes("vpls.vpl", "v.vpl");
  for (const char* name : {"v", "vpls"}) {
    succeed("vpl-estimate", scene_ + " " + path(name + std::string(".vpl")) + " -o " +
                                path(name + std::string("-lit.vpl")) + " --photons 5k");
  }
  const VplTable with = readVpl(at("v-lit.vpl")), without = readVpl(at("vpls-lit.vpl"));
  const auto a = columnsOf(with), b = columnsOf(without);
  ASSERT_EQ(a.size(), b.size() + 1);
  for (size_t c = 0; c < b.size(); ++c)
    EXPECT_TRUE(std::ranges::equal(a[c].bytes, b[c].bytes)) << b[c].name;
}

TEST_F(VplFiles, AnotherVersionIsRefusedWithItsCure) {
  for (const uint32_t version : {1u, 4u, 6u}) {
    std::string bytes = readAll(at("lit.vpl"));
    bytes[offsetof(VplHeader, version)] = static_cast<char>(version);
    write("old.vpl", bytes);
    const std::string says = "byte 8: version " + std::to_string(version) + ", expected 5; ";
    const std::string cure =
        version < 5 ? "rerun vpl-place and every later stage" : "use the bnvpl that wrote it";
    fail("vpl-render", scene_ + " " + path("old.vpl") + " -o " + path("x.exr"), kExitInput,
         {"old.vpl", says + cure});
    fail("vpl-inspect", "info " + path("old.vpl"), kExitInput, {"old.vpl", says + cure});
  }
}

TEST_F(VplFiles, ShardsAndCheckpointsAreNamed) {
  succeed("vpl-place", scene_ + " -n 300 --shard 1/2 --quiet -o " + path("c.shard"));
  interrupt("vpl-render",
            scene_ + " --integrator path --spp 1M --threads 1 --checkpoint " + path("work") +
                " -o " + path("x.exr"),
            "work");
  fs::copy(at("work"), at("work.vpl"));
  for (const auto& [file, told] :
       {std::pair{"c.shard", "is a shard"}, std::pair{"work.vpl", "is a checkpoint"}}) {
    const std::string cure =
        std::string(told) == "is a shard" ? "vpl-merge" : "the command of that run goes on from it";
    fail("vpl-eliminate", path(file) + " -n 9 -o " + path("v.vpl"), kExitInput, {told, cure});
    fail("vpl-estimate", scene_ + " " + path(file) + " -o " + path("l.vpl"), kExitInput,
         {told, cure});
    fail("vpl-render", scene_ + " " + path(file) + " -o " + path("i.exr"), kExitInput,
         {told, cure});
  }
  fail("vpl-inspect", "info " + path("work.vpl"), kExitInput, {"is a checkpoint"});
}

TEST_F(VplFiles, TheWrongStageIsReportedWithItsMakerAndTheRightTools) {
  succeed("vpl-place", scene_ + " -o " + path("light.vpl") + " -n 20 --method light");
  fail("vpl-estimate", scene_ + " " + path("light.vpl") + " -o " + path("x.vpl"), kExitInput,
       {"is of stage lit (by vpl-place --method light): its VPLs have their flux; pass it to "
        "vpl-render"});
  succeed("vpl-eliminate", path("light.vpl") + " -n 10 --method rejection --scene " + scene_ +
                               " -o " + path("some.vpl"));
  fail("vpl-estimate", scene_ + " " + path("some.vpl") + " -o " + path("x.vpl"), kExitInput,
       {"is of stage lit (by vpl-eliminate --method rejection): its VPLs have", "vpl-render"});
  fail("vpl-estimate", scene_ + " " + path("lit.vpl") + " -o " + path("x.vpl"), kExitInput,
       {"is of stage lit (by vpl-estimate"});
  const std::string reject = " --method rejection --scene " + scene_ + " -o " + path("x.vpl");
  fail("vpl-eliminate", path("candidates.vpl") + " -n 9" + reject, kExitInput,
       {"stage lit is needed; make it with vpl-place --method light"});
  fail("vpl-eliminate", path("light.vpl") + " -n 900" + reject, kExitInput,
       {"rerun vpl-place --method light -n 18000"});
  fail("vpl-render", scene_ + " " + path("vpls.vpl") + " -o " + path("x.exr"), kExitInput,
       {"is of stage eliminated (by vpl-eliminate",
        "make it with vpl-estimate or a vpl-place --method that lights VPLs"});
  fail("vpl-inspect",
       "plot " + path("vpls.vpl") + " --scene " + scene_ + " --color flux -o " + path("x.png"),
       kExitInput, {"vpl-estimate or a vpl-place --method that lights VPLs"});
}

}  // namespace
}  // namespace bnvpl
