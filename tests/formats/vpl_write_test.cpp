// What is written is read back unchanged; refused input leaves the old file alone.
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <limits>

#include "formats/vpl/vpl_io.h"
#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

using VplWrite = TestFolder;

VplTable manyRows(VplStage stage, size_t count) {
  VplTable table = validRows(stage, count);
  table.sceneHash = 0xfedcba9876543210u;
  table.provenance = R"([{"tool":"a"},{"tool":"b","options":{"name":"ü"}}])";
  if (stage >= VplStage::Eliminated) table.rMax = 0.1, table.areaEstimate = 1e9;
  return table;
}

TEST_F(VplWrite, EveryStageAndSizeSurvivesTheRoundTrip) {
  for (const VplStage stage : {VplStage::Candidates, VplStage::Eliminated, VplStage::Lit}) {
    // The counts leave padding, and the largest makes columns span many alignment blocks.
    for (const size_t count : {0, 1, 5, 16, 17, 1000}) {
      const VplTable table = manyRows(stage, count);
      writeVpl(at("a.vpl"), table);
      const VplTable read = readVpl(at("a.vpl"), stage);
      expectSame(read, table);
      writeVpl(at("b.vpl"), read);
      EXPECT_TRUE(readAll(at("a.vpl")) == readAll(at("b.vpl")));
      const VplHeader header = readVplHeader(at("a.vpl"));
      EXPECT_EQ(header.stage, stage);
      EXPECT_EQ(header.count, count);
      EXPECT_EQ(header.checksum, read.checksum);
      EXPECT_EQ(header.fileBytes, fs::file_size(at("a.vpl")));
    }
  }
}

TEST_F(VplWrite, SeveralEmissionPointsSurviveTheRoundTrip) {
  for (const uint32_t points : {1u, 3u, kMaxEmitPoints}) {
    const VplTable table = withEmitPoints(manyRows(VplStage::Lit, 17), points);
    writeVpl(at("a.vpl"), table);
    expectSame(readVpl(at("a.vpl")), table);
    const std::vector<uint32_t> rows{16, 2};
    const VplTable kept = keepRows(table, rows);
    EXPECT_EQ(kept.emitPosition.size(), 2 * points);
    EXPECT_EQ(kept.emitPosition.back(), table.emitPosition[3 * points - 1]);
  }
}

TEST_F(VplWrite, EmptyProvenanceIsAnEmptyArray) {
  VplTable table = smallTable(VplStage::Candidates);
  table.provenance.clear();
  writeVpl(at("a.vpl"), table);
  EXPECT_EQ(readVpl(at("a.vpl")).provenance, "[]");
}

// Writes a table of stage Lit, modified by `change`, over a good file. Expects an error that
// contains `what`, and an unchanged file.
template <typename Change>
void expectRefused(const fs::path& file, const std::string& what, const Change& change) {
  writeVpl(file, smallTable(VplStage::Lit));
  const std::string before = readAll(file);
  VplTable table = smallTable(VplStage::Lit);
  change(table);
  try {
    writeVpl(file, table);
    ADD_FAILURE() << "written: " << what;
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
  }
  EXPECT_TRUE(readAll(file) == before);
}

TEST_F(VplWrite, WrongValuesAreRefusedWithColumnAndRow) {
  const fs::path f = at("a.vpl");
  expectRefused(f, "column position, row 1", [](VplTable& t) { t.position[1].y = kNan; });
  expectRefused(f, "column position, row 0", [](VplTable& t) { t.position[0].z = -kInf; });
  expectRefused(f, "column normal, row 0: not a finite", [](VplTable& t) { t.normal[0].x = kNan; });
  expectRefused(f, "column normal, row 1: not of unit", [](VplTable& t) { t.normal[1].x = 0.99f; });
  expectRefused(f, "column albedo, row 0", [](VplTable& t) { t.albedo[0].z = 1.01f; });
  expectRefused(f, "column albedo, row 0", [](VplTable& t) { t.albedo[0].y = -0.01f; });
  expectRefused(f, "column radius, row 1", [](VplTable& t) { t.radius[1] = 0.0f; });
  expectRefused(f, "column radius, row 0", [](VplTable& t) { t.radius[0] = kInf; });
  expectRefused(f, "column flux, row 1", [](VplTable& t) { t.flux[1].x = -1.0f; });
  expectRefused(f, "column flux, row 0", [](VplTable& t) { t.flux[0].x = kNan; });
  expectRefused(f, "column relative_error, row 0", [](VplTable& t) { t.relativeError[0] = kNan; });
  expectRefused(f, "column emit_position, row 1", [](VplTable& t) { t.emitPosition[1].y = kInf; });
  expectRefused(f, "column emit_normal, row 0", [](VplTable& t) { t.emitNormal[0].y = 0.5f; });
  expectRefused(f, "column emit_normal, row 1", [](VplTable& t) {
    t = withEmitPoints(t, 4);
    t.emitNormal[6].x = 0.5f;
  });
  expectRefused(f, "column emit_position has 48 bytes, expected 2 rows of 48", [](VplTable& t) {
    t.emitPosition = withEmitPoints(t, 2).emitPosition, t.emitPoints = 4;
  });
  expectRefused(f, "too many emission points", [](VplTable& t) { t = withEmitPoints(t, 65); });
  expectRefused(f, "column first_bounce_flux, row 1",
                [](VplTable& t) { t.firstBounceFlux[1].y = -1.0f; });
  expectRefused(f, "column first_bounce_flux, row 0: above the flux",
                [](VplTable& t) { t.firstBounceFlux[0].z = 4.5f; });
  expectRefused(f, "r_max", [](VplTable& t) { t.rMax = -1.0; });
  expectRefused(f, "reach", [](VplTable& t) { t.reachFactor = -1.0; });
  expectRefused(f, "area", [](VplTable& t) { t.areaEstimate = static_cast<double>(kNan); });
  for (const double share : {-0.5, 1.5, static_cast<double>(kNan)})
    expectRefused(f, "share of indirect light", [&](VplTable& t) { t.indirectShare = share; });
  expectRefused(f, "provenance", [](VplTable& t) { t.provenance = "{}"; });
  EXPECT_EQ(fileCount(), 1u);  // no partial file remains
}

// Typical JSON printers recurse once per level, so a million levels overflow the stack.
TEST_F(VplWrite, DeepProvenanceIsRefused) {
  const auto nested = [](size_t depth) {
    return "[{\"a\":" + std::string(depth, '[') + std::string(depth, ']') + "}]";
  };
  VplTable table = smallTable(VplStage::Candidates);
  table.provenance = nested(50);
  EXPECT_NO_THROW(writeVpl(at("a.vpl"), table));
  for (const size_t depth : {size_t{70}, size_t{1'000'000}}) {
    table.provenance = nested(depth);
    EXPECT_THROW(writeVpl(at("a.vpl"), table), std::logic_error);
  }
}

TEST_F(VplWrite, UnevenOrSurplusColumnsAreOurBug) {
  VplTable uneven = smallTable(VplStage::Lit);
  uneven.photons.pop_back();
  EXPECT_THROW(writeVpl(at("a.vpl"), uneven), std::logic_error);
  VplTable surplus = smallTable(VplStage::Lit);
  surplus.stage = VplStage::Eliminated;
  EXPECT_THROW(writeVpl(at("a.vpl"), surplus), std::logic_error);
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(VplWrite, FailedWriteLeavesTheOldFile) {
  writeVpl(at("a.vpl"), smallTable(VplStage::Candidates));
  const std::string before = readAll(at("a.vpl"));
  // A limit on file size makes the write itself fail, for root too.
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{4096, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  EXPECT_THROW(writeVpl(at("a.vpl"), manyRows(VplStage::Lit, 1000)), OutputError);
  // The table is small enough to stay in the stream's buffer until it is closed.
  const rlimit tighter{256, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tighter), 0);
  EXPECT_THROW(writeVpl(at("a.vpl"), smallTable(VplStage::Lit)), OutputError);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, oldHandler);
  EXPECT_TRUE(readAll(at("a.vpl")) == before);
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(VplWrite, TargetsThatCannotBeReplacedAreRefused) {
  const VplTable table = smallTable(VplStage::Candidates);
  EXPECT_THROW(writeVpl(at("missing") / "a.vpl", table), OutputError);
  EXPECT_THROW(writeVpl(at("."), table), OutputError);
  EXPECT_THROW(writeVpl("/dev/null", table), OutputError);
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
}

TEST_F(VplWrite, WrongStageIsRefusedNamingTheTool) {
  writeVpl(at("c.vpl"), smallTable(VplStage::Candidates));
  try {
    readVpl(at("c.vpl"), VplStage::Lit);
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("c.vpl"), std::string::npos) << text;
    EXPECT_NE(text.find("stage candidates"), std::string::npos) << text;
    EXPECT_NE(text.find("stage lit is needed"), std::string::npos) << text;
    EXPECT_NE(text.find("(by vpl-place)"), std::string::npos) << text;
    EXPECT_NE(text.find("make it with vpl-estimate or a vpl-place --method that lights VPLs"),
              std::string::npos)
        << text;
  }
  EXPECT_THROW(readVpl(at("c.vpl"), VplStage::Eliminated), InputError);
  EXPECT_NO_THROW(readVpl(at("c.vpl"), VplStage::Candidates));
}

// A lit file need not come from vpl-estimate: the message names its maker if the file records it.
TEST_F(VplWrite, WrongStageNamesTheMakerByTheProvenance) {
  const auto complaint = [&](const std::string& provenance) {
    VplTable table = smallTable(VplStage::Lit);
    table.provenance = provenance;
    writeVpl(at("l.vpl"), table);
    try {
      readVpl(at("l.vpl"), VplStage::Eliminated);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(at("l.vpl").string().size());
    }
    return std::string();
  };
  const std::string cure = ": its VPLs have their flux; pass it to vpl-render";
  EXPECT_EQ(complaint(R"([{"tool":"vpl-place","options":{"method":"light"}}])"),
            ": is of stage lit (by vpl-place --method light)" + cure);
  EXPECT_EQ(complaint(R"([{"tool":"vpl-place"},{"tool":"vpl-estimate","options":{"seed":1}}])"),
            ": is of stage lit (by vpl-estimate)" + cure);
  for (const char* silent : {"[]", "[{}]", R"([{"tool":7}])", R"([{"tool":"\u001b[2J"}])"}) {
    EXPECT_EQ(complaint(silent), ": is of stage lit" + cure);
  }
}

}  // namespace
}  // namespace bnvpl
