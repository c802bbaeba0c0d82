// Shared by the inspect tests: a folder, small tables with a history, images, and a tiny scene.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/hash.h"
#include "formats/image/exr_io.h"
#include "formats/vpl/vpl_io.h"
#include "tests/support/emit_points.h"
#include "tests/support/flat_image.h"
#include "tests/support/messages.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

class InspectTest : public ::testing::Test {
 protected:
  InspectTest()
      : folder_(fs::temp_directory_path() / ("bnvpl-inspect-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~InspectTest() override { fs::remove_all(folder_); }
  fs::path at(const std::string& name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

inline std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeAll(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.good()) << file;
}

// Three rows on the plane z = 0, one and three units apart; every value is exact in binary.
inline VplTable threeRows(VplStage stage) {
  VplTable table;
  table.stage = stage;
  table.position = {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}};
  table.normal = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  table.albedo = {{0.5f, 0.25f, 0.125f}, {1, 0, 0.75f}, {0, 0, 0}};
  table.id = {7, 258, 4000000000u};
  table.sceneHash = 0x1234;
  table.provenance = extendProvenance("", stageRecord("vpl-place", {{"count", 3}, {"seed", 1}},
                                                      {{"scene", hashText(table.sceneHash)}}));
  if (stage >= VplStage::Eliminated) {
    table.radius = {0.5f, 1.0f, 2.0f};
    table.rMax = 0.5;
    table.areaEstimate = 12.0;
  }
  if (stage >= VplStage::Lit) {
    table.flux = {{1, 2, 4}, {0.5f, 0.0f, 0.0f}, {0, 0, 0}};
    table.photons = {4294967297u, 5, 0};
    table.relativeError = {0.0625f, 0.1f, 0};
    table.emitPosition = {{0, 0.25f, 0}, {1, 0, 0}, {4, 0, 0}};
    table.emitNormal = table.normal;
    table.firstBounceFlux = {{0.25f, 2, 0}, {0, 0, 0}, {0, 0, 0}};
  }
  return table;
}

}  // namespace bnvpl
