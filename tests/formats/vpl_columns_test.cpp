// The list of columns and everything derived from it.
#include "formats/vpl/vpl_columns.h"

#include "formats/vpl/vpl_io.h"
#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

constexpr VplStage kStages[] = {VplStage::Candidates, VplStage::Eliminated, VplStage::Lit};

TEST(VplColumns, EveryStageHasItsOwnAndThoseBefore) {
  EXPECT_EQ(standardColumns(VplStage::Candidates).size(), 4u);
  EXPECT_EQ(standardColumns(VplStage::Eliminated).size(), 5u);
  EXPECT_EQ(standardColumns(VplStage::Lit).size(), kVplColumns.size());
  EXPECT_EQ(standardColumns(VplStage::Eliminated).back().name, "radius");
}

TEST(VplColumns, ViewsGiveTheValuesOfTheMembers) {
  VplTable table = smallTable(VplStage::Lit);
  table.extras = someExtras(2);
  const std::vector<VplColumnView> columns = columnsOf(table);
  const auto value = [&](const std::string& name, size_t row, size_t component) {
    for (const VplColumnView& column : columns) {
      if (column.name == name) return column.value(row, component);
    }
    throw std::logic_error("no column " + name);
  };
  EXPECT_EQ(value("position", 1, 2), -0.125);
  EXPECT_EQ(value("id", 1, 0), 258.0);
  EXPECT_EQ(value("flux", 0, 2), 4.0);
  EXPECT_EQ(value("photons", 0, 0), 4294967297.0);
  EXPECT_EQ(value("relative_error", 0, 0), 0.0625);
  EXPECT_EQ(value("emit_position", 0, 1), 2.25);
  EXPECT_EQ(value("emit_normal", 0, 1), 1.0);
  EXPECT_EQ(value("first_bounce_flux", 0, 1), 2.0);
  EXPECT_EQ(value("rich.lobes", 1, 3), -0.25);
  EXPECT_EQ(value("light-slice.cluster", 1, 0), 8.0);
  EXPECT_EQ(value("rich.seeds", 1, 1), 8589934593.0);
  ASSERT_EQ(columns.size(), 14u);
  EXPECT_EQ(columns[11].name, "rich.lobes");
  EXPECT_EQ(columns[13].type, VplType::U64);
}

TEST(VplColumns, KeptRowsHaveAllTheirColumns) {
  for (const VplStage stage : kStages) {
    VplTable table = validRows(stage, 20);
    table.extras = someExtras(20);
    table.rMax = 0.5, table.areaEstimate = 3.0, table.reachFactor = 1.5, table.sceneHash = 7;
    table.provenance = "[{}]", table.checksum = 9, table.indirectShare = 0.25;
    const std::vector<uint32_t> rows{19, 3, 0, 3};
    const VplTable kept = keepRows(table, rows);
    EXPECT_EQ(kept.checksum, 0u);
    EXPECT_EQ(kept.rMax, 0.5);
    EXPECT_EQ(kept.areaEstimate, 3.0);
    EXPECT_EQ(kept.reachFactor, 1.5);
    EXPECT_EQ(kept.indirectShare, 0.25);
    EXPECT_EQ(kept.sceneHash, 7u);
    EXPECT_EQ(kept.provenance, "[{}]");
    const auto from = columnsOf(table), to = columnsOf(kept);
    ASSERT_EQ(from.size(), to.size());
    for (size_t c = 0; c < from.size(); ++c) {
      EXPECT_EQ(to[c].name, from[c].name);
      EXPECT_EQ(to[c].unit, from[c].unit);
      ASSERT_EQ(to[c].bytes.size(), rows.size() * from[c].rowBytes());
      for (size_t i = 0; i < rows.size(); ++i) {
        EXPECT_TRUE(std::ranges::equal(to[c].row(i), from[c].row(rows[i]))) << from[c].name;
      }
    }
    EXPECT_EQ(keepRows(table, {}).size(), 0u);
  }
}

// The table in README.md is generated from the list. If they differ, paste what this test prints.
TEST(VplColumns, TheReadmeHasTheList) {
  std::string table =
      "| Column | Type | Unit | Since | Meaning | Valid |\n|---|---|---|---|---|---|\n";
  for (const VplColumn& c : kVplColumns) {
    const std::string type = std::string(nameOf(c.type())) +
                             (c.components() == 1 ? "" : " × " + std::to_string(c.components()));
    for (const std::string_view cell : {std::string_view(c.name), std::string_view(type), c.unit,
                                        stageName(c.since), c.meaning, c.check.valid}) {
      table += cell == c.name ? "| `" + std::string(cell) + "` " : "| " + std::string(cell) + " ";
    }
    table += "|\n";
  }
  EXPECT_NE(readAll(BNVPL_README).find("\n\n" + table + "\n"), std::string::npos) << table;
}

}  // namespace
}  // namespace bnvpl
