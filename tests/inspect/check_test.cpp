#include "tools/inspect/check/check.h"

#include "core/hash.h"
#include "tests/inspect/foreign_exr.h"
#include "tests/inspect/inspect_files.h"

namespace bnvpl {
namespace {

// Writes a whole chain of files like the stages do; `seed` makes two chains differ.
class Check : public InspectTest {
 protected:
  void writeChain(const std::string& prefix, int seed, uint64_t scene = 0x1234) {
    const Json sceneInput{{"scene", hashText(scene)}};
    VplTable table = threeRows(VplStage::Candidates);
    table.sceneHash = scene;
    table.provenance = extendProvenance("", stageRecord("vpl-place", {{"seed", seed}}, sceneInput));
    writeVpl(at(prefix + "candidates.vpl"), table);
    const std::string placed = hashText(readVpl(at(prefix + "candidates.vpl")).checksum);

    VplTable kept = threeRows(VplStage::Eliminated);
    kept.sceneHash = scene;
    kept.provenance = extendProvenance(
        table.provenance, stageRecord("vpl-eliminate", Json::object(), {{"candidates", placed}}));
    writeVpl(at(prefix + "vpls.vpl"), kept);
    const std::string eliminated = hashText(readVpl(at(prefix + "vpls.vpl")).checksum);

    VplTable lit = threeRows(VplStage::Lit);
    lit.sceneHash = scene;
    lit.provenance = extendProvenance(
        kept.provenance, stageRecord("vpl-estimate", Json::object(),
                                     {{"scene", hashText(scene)}, {"vpls", eliminated}}));
    writeVpl(at(prefix + "lit.vpl"), lit);

    Image image = flatImage(2, 1, 1, 1, 1);
    image.attributes["bnvpl.provenance"] = extendProvenance(
        lit.provenance, stageRecord("vpl-render", Json::object(),
                                    {{"scene", hashText(scene)},
                                     {"lit", hashText(readVpl(at(prefix + "lit.vpl")).checksum)}}));
    image.attributes[kImageHashAttribute] = hashText(hashImage(image, ExrPixelType::Half));
    writeExr(at(prefix + "image.exr"), image, ExrPixelType::Half);
  }
  std::string problem(const std::vector<std::string>& names) {
    return messageOf<InputError>([&] {
      std::vector<CheckedFile> files;
      for (const std::string& name : names) files.push_back(checkFile(at(name)));
      checkTogether(files);
    });
  }
};

TEST_F(Check, AWholeChainPassesInAnyOrder) {
  writeChain("a-", 1);
  EXPECT_EQ(problem({"a-candidates.vpl", "a-vpls.vpl", "a-lit.vpl", "a-image.exr"}), "");
  EXPECT_EQ(problem({"a-image.exr", "a-lit.vpl", "a-vpls.vpl", "a-candidates.vpl"}), "");
  EXPECT_EQ(problem({"a-candidates.vpl", "a-image.exr"}), "");
}

TEST_F(Check, AMixedChainNamesTheStageToRerun) {
  writeChain("a-", 1);
  writeChain("b-", 2);
  EXPECT_TRUE(contains(problem({"a-candidates.vpl", "b-vpls.vpl"}), "rerun vpl-eliminate"));
  EXPECT_TRUE(contains(problem({"a-vpls.vpl", "b-lit.vpl"}), "rerun vpl-estimate"));
  EXPECT_TRUE(contains(problem({"a-lit.vpl", "b-image.exr"}), "rerun vpl-render"));
  EXPECT_TRUE(contains(problem({"a-candidates.vpl", "b-image.exr"}), "rerun vpl-eliminate"));
  // The message names the earliest stage that is out of date, although the image comes first.
  EXPECT_TRUE(
      contains(problem({"b-image.exr", "a-lit.vpl", "a-candidates.vpl"}), "rerun vpl-eliminate"));
}

TEST_F(Check, TwoWholeChainsPass) {
  writeChain("a-", 1);
  writeChain("b-", 2);
  EXPECT_EQ(problem({"a-vpls.vpl", "b-vpls.vpl", "a-lit.vpl", "b-lit.vpl"}), "");
}

TEST_F(Check, FilesOfTwoScenesAreRefused) {
  writeChain("a-", 1, 0x1111);
  writeChain("b-", 1, 0x2222);
  EXPECT_TRUE(contains(problem({"a-image.exr", "b-image.exr"}), "rerun vpl-place"));
  EXPECT_TRUE(contains(problem({"a-candidates.vpl", "b-candidates.vpl"}), "0000000000002222"));
}

TEST_F(Check, AFileThatContradictsItsHistoryIsRefused) {
  VplTable table = threeRows(VplStage::Candidates);
  table.sceneHash = 0x9999;  // its record says 0x1234
  writeVpl(at("a.vpl"), table);
  EXPECT_TRUE(contains(problem({"a.vpl"}), "rerun vpl-place"));
}

TEST_F(Check, DamageIsFound) {
  writeChain("a-", 1);
  for (const char* name : {"a-lit.vpl", "a-image.exr"}) {
    const std::string bytes = readAll(at(name));
    writeAll(at(name), bytes.substr(0, bytes.size() - 3));
    EXPECT_NE(problem({name}), "") << name;
  }
  Image image = flatImage(2, 2, 1, 1, 1);
  image.channels[2].data[3] = NAN;
  writeForeignExr(at("nan.exr"), image);
  EXPECT_TRUE(contains(problem({"nan.exr"}), "channel B is not finite at pixel (1, 1)"));
  image = flatImage(2, 2, 1, 1, 1);
  image.attributes["bnvpl.provenance"] = "{";
  image.attributes[kImageHashAttribute] = hashText(hashImage(image, ExrPixelType::Float));
  writeExr(at("text.exr"), image, ExrPixelType::Float);
  EXPECT_TRUE(contains(problem({"text.exr"}), "provenance"));
}

// Other programs and later versions may write keys of other types: these are shown or skipped.
TEST_F(Check, StrangeRecordsPass) {
  VplTable table = threeRows(VplStage::Candidates);
  table.provenance = R"([{"tool":5,"options":[1],"inputs":"x"},{},{"inputs":{"lit":7}}])";
  writeVpl(at("a.vpl"), table);
  EXPECT_EQ(problem({"a.vpl"}), "");
  EXPECT_EQ(parseProvenance("a", table.provenance)[0].tool, "5");
}

}  // namespace
}  // namespace bnvpl
