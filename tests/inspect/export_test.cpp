#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>

#include "formats/vpl/vpl_columns.h"
#include "tests/inspect/inspect_files.h"
#include "tools/inspect/export/export_table.h"

namespace bnvpl {
namespace {

class Export : public InspectTest {
 protected:
  // Exports the table and reads the file back.
  std::string exported(const std::string& name, const VplTable& table) const {
    AtomicFile file(at(name));
    exportTable(table, file);
    file.commit();
    return readAll(at(name));
  }
};

// A PLY file read by its header: name -> value for each vertex, and three indices for each face.
struct Ply {
  explicit Ply(const std::string& bytes) {
    std::istringstream in(bytes);
    std::string line, first, second, third;
    std::vector<std::pair<std::string, std::string>> properties;  // types and names
    size_t vertexCount = 0, faceCount = 0;
    while (std::getline(in, line) && line != "end_header") {
      header.push_back(line);
      std::istringstream words(line);
      words >> first >> second >> third;
      if (first == "element") (second == "vertex" ? vertexCount : faceCount) = std::stoul(third);
      if (first == "property" && second != "list") properties.emplace_back(second, third);
    }
    size_t next = static_cast<size_t>(in.tellg());
    const auto take = [&](auto value) {
      std::memcpy(&value, bytes.data() + next, sizeof value);
      next += sizeof value;
      return value;
    };
    const auto number = [&](const std::string& type) {
      if (type == "uchar") return double(take(uint8_t{}));
      if (type == "uint") return double(take(uint32_t{}));
      return type == "double" ? take(double{}) : double(take(float{}));
    };
    vertices.resize(vertexCount);
    for (auto& vertex : vertices) {
      for (const auto& [type, name] : properties) vertex[name] = number(type);
    }
    faces.resize(faceCount);
    for (auto& face : faces) {
      EXPECT_EQ(take(uint8_t{}), 3);
      for (int& vertex : face) vertex = take(int32_t{});
    }
    EXPECT_EQ(next, bytes.size());
  }
  bool says(const std::string& line) const {
    return std::find(header.begin(), header.end(), line) != header.end();
  }
  Vec3 place(size_t vertex) const {
    return {float(vertices[vertex].at("x")), float(vertices[vertex].at("y")),
            float(vertices[vertex].at("z"))};
  }
  std::vector<std::string> header;
  std::vector<std::map<std::string, double>> vertices;
  std::vector<std::array<int, 3>> faces;
};

VplTable withLobes(VplStage stage) {
  VplTable table = threeRows(stage);
  table.extras = {{"rich.lobes", "1", 2, std::vector<float>{0, 1, 2, 3, 4, 5}},
                  {"rich.seed", "-", 1, std::vector<uint64_t>{9007199254740993u, 8, 9}}};
  return table;
}

TEST_F(Export, PlyHasEveryColumnOfLitRows) {
  const Ply ply(exported("a.ply", withLobes(VplStage::Lit)));
  ASSERT_EQ(ply.header[0], "ply");
  ASSERT_EQ(ply.header[1], "format binary_little_endian 1.0");
  const auto number = [&](size_t row, const char* name) { return ply.vertices[row].at(name); };
  EXPECT_EQ(ply.place(0), Vec3(0, 0.25f, 0));  // taken from emit_position
  EXPECT_EQ(number(0, "nz"), 1.0);
  EXPECT_EQ(number(0, "position_y"), 0.0);
  EXPECT_EQ(number(2, "position_x"), 4.0);
  EXPECT_EQ(number(1, "normal_z"), 1.0);
  EXPECT_EQ(number(1, "albedo_b"), 0.75);
  EXPECT_EQ(number(2, "id"), 4000000000.0);
  EXPECT_EQ(number(2, "radius"), 2.0);
  EXPECT_EQ(number(0, "flux_b"), 4.0);
  EXPECT_EQ(number(0, "photons"), 4294967297.0);
  EXPECT_EQ(number(0, "relative_error"), 0.0625);
  EXPECT_EQ(number(0, "first_bounce_flux_g"), 2.0);
  EXPECT_EQ(number(1, "rich.lobes_1"), 3.0);
  EXPECT_EQ(number(1, "rich.seed"), 8.0);
  EXPECT_EQ(number(0, "blue"), 255.0);   // the strongest flux
  EXPECT_EQ(number(0, "green"), 188.0);  // half of the strongest, sRGB encoded
  EXPECT_EQ(number(2, "red"), 0.0);
  size_t numbers = 3;  // the three colours
  for (const VplColumnView& column : columnsOf(withLobes(VplStage::Lit)))
    numbers += column.components;
  EXPECT_EQ(ply.vertices[0].size(), numbers);
}

TEST_F(Export, RowsWithSeveralEmissionPointsStandAtTheFirst) {
  VplTable table = threeRows(VplStage::Lit);
  table.emitPoints = 2;
  table.emitPosition = {{0, 0.5f, 0}, {0, 2, 0}, {1, 0, 0}, {1, 0, 0.25f}, {4, 0, 0}, {5, 0, 0}};
  table.emitNormal.assign(6, {0, 0, 1});
  const Ply ply(exported("a.ply", table));
  EXPECT_EQ(ply.place(0), Vec3(0, 0.5f, 0));
  EXPECT_EQ(ply.place(2), Vec3(4, 0, 0));
  EXPECT_EQ(ply.vertices[0].at("emit_position_1_y"), 2.0);
  EXPECT_EQ(ply.vertices[1].at("emit_position_1_z"), 0.25);
  EXPECT_EQ(ply.vertices[2].at("emit_normal_0_z"), 1.0);
}

TEST_F(Export, PlyOfCandidatesShowsTheAlbedo) {
  const Ply ply(exported("a.ply", threeRows(VplStage::Candidates)));
  EXPECT_EQ(ply.place(2), Vec3(4, 0, 0));
  EXPECT_EQ(ply.vertices[0].count("radius"), 0u);
  EXPECT_EQ(ply.vertices[0].size(), 3u + 3 + 3 + 3 + 1);  // albedo twice: as colour and exact
  EXPECT_EQ(ply.vertices[0].at("red"), 188.0);            // albedo 0.5
}

// Blender 3.4 reads colours from red, green and blue of type uchar, assigns them to face corners,
// derives normals from the faces' geometry, and finds faces in the list vertex_indices. MeshLab
// reads nx, ny and nz.
TEST_F(Export, PlyHasWhatBlenderAndMeshLabRead) {
  for (const VplStage stage : {VplStage::Candidates, VplStage::Eliminated, VplStage::Lit}) {
    VplTable table = threeRows(stage);
    table.normal = {{0, 0, -1}, {0.6f, 0, 0.8f}, {-1, 0, 0}};
    if (stage == VplStage::Lit) table.emitNormal = table.normal;
    const std::vector<Vec3>& places = stage == VplStage::Lit ? table.emitPosition : table.position;
    const Ply ply(exported("a.ply", table));
    EXPECT_TRUE(ply.says("property list uchar int vertex_indices"));
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
      EXPECT_TRUE(ply.says(std::string("property float ") + name));
    for (const char* name : {"red", "green", "blue"})
      EXPECT_TRUE(ply.says(std::string("property uchar ") + name));
    ASSERT_EQ(ply.vertices.size(), 9u);
    ASSERT_EQ(ply.faces.size(), 3u);
    for (size_t row = 0; row < 3; ++row) {
      EXPECT_EQ(ply.place(row), places[row]);
      const auto& face = ply.faces[row];
      EXPECT_EQ(face, (std::array{int(row), int(3 + 2 * row), int(4 + 2 * row)}));
      const Vec3 a = ply.place(face[0]), b = ply.place(face[1]), c = ply.place(face[2]);
      const Vec3 n = cross(b - a, c - a);
      EXPECT_GT(dot(normalize(n), table.normal[row]), 0.99999f);
      if (!table.radius.empty()) {
        EXPECT_NEAR(length(b - a), 0.5f * table.radius[row], 1e-6f);
      }
      for (const int corner : {face[1], face[2]}) {
        auto here = ply.vertices[corner], there = ply.vertices[row];
        for (const char* axis : {"x", "y", "z"}) here.erase(axis), there.erase(axis);
        EXPECT_EQ(here, there);
      }
    }
  }
}

// Coordinates far from 0 have a coarse resolution: facets grow until their normals are accurate.
TEST_F(Export, PlyFacetsHaveADirectionEverywhere) {
  VplTable table = threeRows(VplStage::Eliminated);
  table.position = {{1e6f, -2e6f, 3e6f}, {0, 0, 0}, {1e-6f, 0, 0}};
  table.normal = {normalize({1, 2, 3}), {0, 1, 0}, {1, 0, 0}};
  table.radius = {1e-3f, 1e-3f, 1e-6f};
  const Ply ply(exported("a.ply", table));
  for (size_t row = 0; row < 3; ++row) {
    const Vec3 a = ply.place(row), b = ply.place(3 + 2 * row), c = ply.place(4 + 2 * row);
    EXPECT_GT(dot(normalize(cross(b - a, c - a)), table.normal[row]), 0.9999f) << row;
  }
  VplTable one;
  one.position = {{0, 0, 0}}, one.normal = {{0, 0, 1}}, one.albedo = {Vec3(1.0f)}, one.id = {0};
  const Ply lonely(exported("b.ply", one));
  EXPECT_EQ(cross(lonely.place(1), lonely.place(2)), Vec3(0, 0, 1));
  EXPECT_TRUE(Ply(exported("c.ply", VplTable())).vertices.empty());
}

TEST_F(Export, CsvGivesEveryValueBack) {
  VplTable table = withLobes(VplStage::Lit);
  table.position[1] = {0.1f, -1e-20f, 16777217.0f};
  std::istringstream in(exported("a.csv", table));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(
      line,
      "position_x,position_y,position_z,normal_x,normal_y,normal_z,albedo_r,albedo_g,albedo_b,"
      "id,radius,flux_r,flux_g,flux_b,photons,relative_error,"
      "emit_position_x,emit_position_y,emit_position_z,emit_normal_x,emit_normal_y,emit_normal_z,"
      "first_bounce_flux_r,first_bounce_flux_g,first_bounce_flux_b,rich.lobes_0,rich.lobes_1,"
      "rich.seed");
  const std::vector<VplColumnView> columns = columnsOf(table);
  for (size_t row = 0; row < table.size(); ++row) {
    ASSERT_TRUE(std::getline(in, line));
    if (row == 0) {
      EXPECT_TRUE(line.ends_with(",9007199254740993"));  // needs more digits than a double holds
    }
    std::istringstream cells(line);
    std::string cell;
    for (const VplColumnView& column : columns) {
      for (size_t k = 0; k < column.components; ++k) {
        ASSERT_TRUE(std::getline(cells, cell, ','));
        if (column.type == VplType::F32) {
          EXPECT_EQ(std::stof(cell), static_cast<float>(column.value(row, k))) << cell;
        } else {
          EXPECT_EQ(double(std::stoull(cell)), column.value(row, k)) << cell;
        }
      }
    }
    EXPECT_FALSE(std::getline(cells, cell, ','));
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST_F(Export, ManyRowsAreWrittenInPieces) {
  VplTable table;
  for (uint32_t i = 0; i < 20000; ++i) {
    table.position.emplace_back(float(i), 1.0f, 2.0f);
    table.normal.emplace_back(0.0f, 1.0f, 0.0f);
    table.albedo.emplace_back(0.5f);
    table.id.push_back(i);
  }
  const Ply ply(exported("a.ply", table));
  EXPECT_EQ(ply.vertices[19999].at("id"), 19999.0);
  EXPECT_EQ(ply.vertices[59999].at("id"), 19999.0);
  const std::string csv = exported("a.csv", table);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 20001);
  EXPECT_TRUE(csv.ends_with("\n19999,1,2,0,1,0,0.5,0.5,0.5,19999\n"));
}

TEST_F(Export, WritesByExtension) {
  const VplTable table = threeRows(VplStage::Eliminated);
  EXPECT_TRUE(exported("a.ply", table).starts_with("ply\n"));
  EXPECT_TRUE(exported("a.csv", table).starts_with("position_x,"));
  EXPECT_THROW(exported("a.obj", table), UsageError);
  EXPECT_THROW(exported("a", table), UsageError);
  EXPECT_THROW(exported("absent/a.ply", table), OutputError);
}

}  // namespace
}  // namespace bnvpl
