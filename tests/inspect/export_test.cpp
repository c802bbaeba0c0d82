#include <cstring>
#include <sstream>

#include "tests/inspect/inspect_files.h"
#include "tools/inspect/export_table.h"

namespace bnvpl {
namespace {

class Export : public InspectTest {
 protected:
  void exportTo(const std::string& name, const VplTable& table) const {
    AtomicFile file(at(name));
    exportTable(table, file);
    file.commit();
  }
};

TEST_F(Export, PlyParsesBack) {
  const VplTable table = threeRows(VplStage::Lit);
  const std::string bytes = plyBytes(table);
  std::istringstream in(bytes);
  std::string line, type, name;
  size_t vertices = 0, rowBytes = 0;
  std::map<std::string, size_t> offset;
  std::getline(in, line);
  ASSERT_EQ(line, "ply");
  std::getline(in, line);
  ASSERT_EQ(line, "format binary_little_endian 1.0");
  while (std::getline(in, line) && line != "end_header") {
    std::istringstream words(line);
    std::string key;
    words >> key >> type >> name;
    if (key == "element") {
      ASSERT_EQ(type, "vertex");
      vertices = std::stoul(name);
    } else if (key == "property") {
      offset[name] = rowBytes;
      rowBytes += type == "uchar" ? 1 : 4;
    }
  }
  ASSERT_EQ(vertices, table.size());
  const size_t start = static_cast<size_t>(in.tellg());
  ASSERT_EQ(bytes.size(), start + vertices * rowBytes);
  const auto number = [&](size_t row, const char* column) {
    float value = 0;
    std::memcpy(&value, bytes.data() + start + row * rowBytes + offset.at(column), sizeof value);
    return value;
  };
  EXPECT_EQ(number(2, "x"), 4.0f);
  EXPECT_EQ(number(0, "nz"), 1.0f);
  EXPECT_EQ(number(2, "radius"), 2.0f);
  EXPECT_EQ(number(0, "flux_b"), 4.0f);
  EXPECT_EQ(number(1, "photons"), 5.0f);
  EXPECT_EQ(number(0, "relative_error"), 0.0625f);
  EXPECT_EQ(number(0, "straight_flux_g"), 2.0f);
  uint32_t id = 0;
  std::memcpy(&id, bytes.data() + start + 2 * rowBytes + offset.at("id"), sizeof id);
  EXPECT_EQ(id, 4000000000u);
  const auto colour = [&](size_t row, const char* column) {
    return static_cast<uint8_t>(bytes[start + row * rowBytes + offset.at(column)]);
  };
  EXPECT_EQ(colour(0, "blue"), 255);   // the strongest flux
  EXPECT_EQ(colour(0, "green"), 188);  // half of it, sRGB encoded
  EXPECT_EQ(colour(2, "red"), 0);
}

TEST_F(Export, PlyOfCandidatesShowsTheAlbedo) {
  const std::string bytes = plyBytes(threeRows(VplStage::Candidates));
  EXPECT_FALSE(contains(bytes, "radius"));
  const size_t start = bytes.find("end_header\n") + 11;
  EXPECT_EQ(bytes.size(), start + 3u * (24 + 3 + 4));
  EXPECT_EQ(static_cast<uint8_t>(bytes[start + 24]), 188);  // albedo 0.5
}

TEST_F(Export, CsvGivesEveryValueBack) {
  VplTable table = threeRows(VplStage::Lit);
  table.position[1] = {0.1f, -1e-20f, 16777217.0f};
  std::istringstream in(csvText(table));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(
      line,
      "position_x,position_y,position_z,normal_x,normal_y,normal_z,albedo_r,albedo_g,albedo_b,"
      "id,radius,flux_r,flux_g,flux_b,photons,relative_error,"
      "emit_position_x,emit_position_y,emit_position_z,emit_normal_x,emit_normal_y,emit_normal_z,"
      "straight_flux_r,straight_flux_g,straight_flux_b");
  for (size_t row = 0; row < table.size(); ++row) {
    ASSERT_TRUE(std::getline(in, line));
    std::istringstream cells(line);
    std::string cell;
    const auto infos = columnInfo(table.stage);
    for (size_t c = 0; c < infos.size(); ++c) {
      for (size_t k = 0; k < infos[c].components; ++k) {
        ASSERT_TRUE(std::getline(cells, cell, ','));
        const double expected = columnValue(table, c, row, k);
        if (infos[c].type == VplType::F32) {
          EXPECT_EQ(std::stof(cell), static_cast<float>(expected)) << cell;
        } else {
          EXPECT_EQ(std::stoull(cell), static_cast<unsigned long long>(expected)) << cell;
        }
      }
    }
    EXPECT_FALSE(std::getline(cells, cell, ','));
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST_F(Export, WritesByExtension) {
  const VplTable table = threeRows(VplStage::Eliminated);
  exportTo("a.ply", table);
  exportTo("a.csv", table);
  EXPECT_EQ(readAll(at("a.ply")), plyBytes(table));
  EXPECT_EQ(readAll(at("a.csv")), csvText(table));
  EXPECT_THROW(exportTo("a.obj", table), UsageError);
  EXPECT_THROW(exportTo("a", table), UsageError);
  EXPECT_THROW(exportTo("absent/a.ply", table), OutputError);
}

}  // namespace
}  // namespace bnvpl
