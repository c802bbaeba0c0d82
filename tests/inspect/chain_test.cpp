// Files that no stage writes: their contents were changed and hashed again.
#include "tools/inspect/check/chain.h"

#include "core/hash.h"
#include "tests/inspect/inspect_files.h"

namespace bnvpl {
namespace {

class DeepCheck : public InspectTest {
 protected:
  void SetUp() override {
    candidates_ = threeRows(VplStage::Candidates);
    kept_ = threeRows(VplStage::Eliminated);
    lit_ = threeRows(VplStage::Lit);
    lit_.reachFactor = 2.0;
  }
  // Writes the tables as a chain with correct histories; returns the problem found in the rows.
  std::string problem() {
    writeVpl(at("c.vpl"), candidates_);
    kept_.provenance = extendProvenance(
        candidates_.provenance,
        stageRecord("vpl-eliminate", {{"count", 3}}, {{"candidates", checksum("c.vpl")}}));
    writeVpl(at("v.vpl"), kept_);
    lit_.provenance = extendProvenance(
        kept_.provenance, stageRecord("vpl-estimate", {{"radius", 0.3f}, {"emit-points", 4}},
                                      {{"scene", hashText(0x1234)}, {"vpls", checksum("v.vpl")}}));
    writeVpl(at("l.vpl"), lit_);
    return messageOf<InputError>([&] {
      const std::vector<CheckedFile> files{checkFile(at("l.vpl")), checkFile(at("c.vpl")),
                                           checkFile(at("v.vpl"))};
      checkChain(files, nullptr);
    });
  }
  std::string checksum(const std::string& name) const {
    return hashText(readVpl(at(name)).checksum);
  }

  VplTable candidates_, kept_, lit_;
};

TEST_F(DeepCheck, ChangedRowsAreRefused) {
  EXPECT_EQ(problem(), "");
  kept_.indirectShare = 0.5;
  EXPECT_TRUE(contains(problem(), "v.vpl: its share of indirect light is not that of"));
  kept_.indirectShare = candidates_.indirectShare;
  kept_.position[1].x += 0.001f;
  EXPECT_TRUE(contains(problem(), "v.vpl: row 1 (id 258) is not that of"));
  kept_.position[1] = candidates_.position[1];
  kept_.id[2] = lit_.id[2] = 5;
  EXPECT_TRUE(contains(problem(), "v.vpl: row 2 (id 5)"));
  kept_.id[2] = lit_.id[2] = candidates_.id[2];
  lit_.radius[0] *= 2.0f;
  EXPECT_TRUE(contains(problem(), "l.vpl: row 0 (id 7)"));
  lit_.radius[0] = kept_.radius[0];
  lit_.position[0].y += 0.001f;
  EXPECT_TRUE(contains(problem(), "l.vpl: row 0 (id 7)"));
  lit_.position[0] = kept_.position[0];
  lit_.emitPosition[0].y = 0.9f;  // within the reach of 2 * 0.5
  EXPECT_EQ(problem(), "");
  lit_.emitPosition[0].y = 1.1f;
  EXPECT_TRUE(contains(problem(), "l.vpl: row 0 (id 7)"));
  lit_.emitPosition[0].y = 0.9f;
  lit_ = withEmitPoints(lit_, 2);
  EXPECT_EQ(problem(), "");
  lit_.emitPosition[3].y += 10.0f;
  EXPECT_TRUE(contains(problem(), "l.vpl: row 1 (id 258)"));
}

TEST_F(DeepCheck, AHistoryThatWasRewrittenIsRefused) {
  ASSERT_EQ(problem(), "");
  lit_.provenance =
      R"([{"tool":"vpl-place","version":")" BNVPL_VERSION R"(","options":{},"inputs":{}},)"
      R"({"tool":"vpl-eliminate","version":")" BNVPL_VERSION
      R"(","options":{},"inputs":{}},{"tool":"vpl-estimate","version":"0","options":{},"inputs":{"vpls":")" +
      checksum("v.vpl") + R"("}}])";
  writeVpl(at("l.vpl"), lit_);
  const std::vector<CheckedFile> files{checkFile(at("c.vpl")), checkFile(at("v.vpl")),
                                       checkFile(at("l.vpl"))};
  EXPECT_TRUE(contains(messageOf<InputError>([&] { checkChain(files, nullptr); }),
                       "history does not continue"));
}

TEST_F(DeepCheck, ToolsOfTwoVersionsAreRefused) {
  ASSERT_EQ(problem(), "");
  Json record = stageRecord("vpl-estimate", Json::object(), {{"vpls", checksum("v.vpl")}});
  record["version"] = "9.9";
  lit_.provenance = extendProvenance(kept_.provenance, record);
  writeVpl(at("l.vpl"), lit_);
  const std::vector<CheckedFile> files{checkFile(at("c.vpl")), checkFile(at("v.vpl")),
                                       checkFile(at("l.vpl"))};
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { checkChain(files, nullptr); }), "made by version 9.9"));
}

TEST_F(DeepCheck, CommandsAreQuotedAndExact) {
  StageRecord record;
  record.tool = "vpl-estimate";
  record.options = {{"radius", 0.1}, {"emit-points", 4}, {"method", "guarded"}, {"photons", 5}};
  EXPECT_EQ(commandOf(record, {"my scene.toml", "v.vpl"}, "it's.vpl"),
            "vpl-estimate 'my scene.toml' v.vpl -o 'it'\\''s.vpl' --radius 0.1 --emit-points 4 "
            "--method guarded --photons 5");
  // A stranger's file may record anything.
  record.options = {{"radius", Json::array({"$(touch mine)"})}};
  EXPECT_EQ(commandOf(record, {"s.toml"}, "l.vpl"),
            "vpl-estimate s.toml -o l.vpl --radius '[\"$(touch mine)\"]'");
}

TEST_F(DeepCheck, AnImageThatWasEditedIsRefused) {
  Image image = flatImage(3, 2, 0.1f, 1.0f / 3.0f, 70000.0f);
  image.attributes["bnvpl.provenance"] = "[]";
  for (const ExrPixelType type : {ExrPixelType::Half, ExrPixelType::Float}) {
    image.attributes[kImageHashAttribute] = hashText(hashImage(image, type));
    writeExr(at("a.exr"), image, type);
    EXPECT_EQ(messageOf<InputError>([&] { checkFile(at("a.exr")); }), "");
    Image edited = readExr(at("a.exr"));
    edited.channels[1].data[4] *= 1.01f;
    writeExr(at("b.exr"), edited, ExrPixelType::Float);
    EXPECT_TRUE(
        contains(messageOf<InputError>([&] { checkFile(at("b.exr")); }), "rerun vpl-render"));
    edited = readExr(at("a.exr"));
    edited.attributes.erase(kImageHashAttribute);
    writeExr(at("b.exr"), edited, ExrPixelType::Float);
    EXPECT_TRUE(contains(messageOf<InputError>([&] { checkFile(at("b.exr")); }),
                         "its attribute bnvpl.hash is gone"));
    edited = readExr(at("a.exr"));
    edited.attributes["bnvpl.provenance"] = "[{}]";
    writeExr(at("b.exr"), edited, ExrPixelType::Float);
    EXPECT_TRUE(
        contains(messageOf<InputError>([&] { checkFile(at("b.exr")); }), "rerun vpl-render"));
  }
}

}  // namespace
}  // namespace bnvpl
