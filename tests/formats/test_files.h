// Shared by the format tests: a temporary folder, whole files as strings, and small tables.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/errors.h"
#include "formats/vpl/vpl_format.h"
#include "tests/support/emit_points.h"

namespace bnvpl {

class TestFolder : public ::testing::Test {
 protected:
  TestFolder()
      : folder_(fs::temp_directory_path() / ("bnvpl-formats-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~TestFolder() override { fs::remove_all(folder_); }
  fs::path at(const std::string& name) const { return folder_ / name; }
  size_t fileCount() const {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

inline std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeAll(const fs::path& file, const std::string& bytes) {
  fs::remove(file);  // truncating an old file makes some file systems flush it at once
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.good()) << file;
}

// Overwrites the bytes of one field.
template <typename T>
void poke(std::string& bytes, size_t offset, const T& value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

// A valid value of the column that varies with column and row as far as the column's check allows.
inline Vec3 validValue(const VplColumn& column, size_t index, const VplTable& table, size_t row) {
  const auto x = static_cast<float>(row), c = static_cast<float>(index);
  const Vec3 choices[] = {Vec3(x, c - x, 0.1f * x + c), Vec3(x + c, 2.0f * x + 0.5f, c * x + 0.5f),
                          Vec3(1.0f / (x + c + 1.0f), 0.5f, 0.0f),
                          Vec3(std::sin(x + c), 0.0f, std::cos(x + c)), Vec3(0.0f)};
  for (const Vec3 v : choices) {
    if (column.check.problem == nullptr || column.check.problem(v, table, row) == nullptr) return v;
  }
  throw std::logic_error("no value suits column " + std::string(column.name));
}

// `count` rows with valid values in all columns of the stage.
inline VplTable validRows(VplStage stage, size_t count) {
  VplTable table;
  table.stage = stage;
  size_t index = 0;
  for (const VplColumn& column : standardColumns(stage)) {
    for (size_t row = 0; row < count; ++row) {
      const Vec3 value = validValue(column, index, table, row);
      if (column.components() == 3) {
        (table.*std::get<0>(column.member)).push_back(value);
      } else if (column.type() == VplType::F32) {
        (table.*std::get<1>(column.member)).push_back(validValue(column, index, table, row).y);
      } else if (column.type() == VplType::U32) {
        (table.*std::get<2>(column.member)).push_back(static_cast<uint32_t>(row * 3 + index));
      } else {
        (table.*std::get<3>(column.member)).push_back((row << 33) + index);
      }
    }
    ++index;
  }
  return table;
}

// Extra columns of two methods, covering every type.
inline std::vector<VplExtraColumn> someExtras(size_t rows) {
  VplExtraColumn lobes{"rich.lobes", "W", 4, std::vector<float>()};
  VplExtraColumn cluster{"light-slice.cluster", "-", 1, std::vector<uint32_t>()};
  VplExtraColumn seeds{"rich.seeds", "1", 2, std::vector<uint64_t>()};
  for (size_t row = 0; row < rows; ++row) {
    for (size_t k = 0; k < 4; ++k)
      std::get<0>(lobes.values).push_back(0.25f * static_cast<float>(k) - static_cast<float>(row));
    std::get<1>(cluster.values).push_back(static_cast<uint32_t>(row) + 7);
    for (size_t k = 0; k < 2; ++k) std::get<2>(seeds.values).push_back((row << 33) + k);
  }
  return {lobes, cluster, seeds};
}

// Expects equal columns and metadata; the checksums may differ.
inline void expectSame(const VplTable& a, const VplTable& b) {
  EXPECT_EQ(a.stage, b.stage);
  EXPECT_EQ(a.rMax, b.rMax);
  EXPECT_EQ(a.areaEstimate, b.areaEstimate);
  EXPECT_EQ(a.reachFactor, b.reachFactor);
  EXPECT_EQ(a.indirectShare, b.indirectShare);
  EXPECT_EQ(a.emitPoints, b.emitPoints);
  EXPECT_EQ(a.sceneHash, b.sceneHash);
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.extras, b.extras);
  for (const VplColumn& column : kVplColumns) {
    EXPECT_TRUE(std::visit([&](auto member) { return a.*member == b.*member; }, column.member))
        << column.name;
  }
}

// Two rows whose values are exact in binary, so that the bytes can be checked by hand.
inline VplTable smallTable(VplStage stage) {
  VplTable table;
  table.stage = stage;
  table.position = {{1.0f, 2.0f, -3.0f}, {0.5f, 0.25f, -0.125f}};
  table.normal = {{0.0f, 0.0f, 1.0f}, {-1.0f, 0.0f, 0.0f}};
  table.albedo = {{0.5f, 0.25f, 0.125f}, {1.0f, 0.0f, 0.75f}};
  table.id = {7, 258};
  table.indirectShare = 0.625;
  table.sceneHash = 0x0123456789abcdefu;
  table.provenance = R"([{"tool":"vpl-place","version":"0.1.0","options":{"seed":1}}])";
  if (stage >= VplStage::Eliminated) {
    table.radius = {0.5f, 1.5f};
    table.rMax = 0.75;
    table.areaEstimate = 12.0;
  }
  if (stage >= VplStage::Lit) {
    table.reachFactor = 2.5;
    table.flux = {{1.0f, 2.0f, 4.0f}, {0.0f, 0.0f, 0.0f}};
    table.photons = {4294967297u, 0};
    table.relativeError = {0.0625f, 0.0f};
    table.emitPosition = {{1.0f, 2.25f, -3.0f}, {0.5f, 0.25f, -0.125f}};
    table.emitNormal = {{0.0f, 1.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}};
    table.firstBounceFlux = {{0.5f, 2.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
  }
  return table;
}

}  // namespace bnvpl
