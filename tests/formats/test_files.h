// What the format tests share: a folder of their own, whole files as strings, and small tables.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "core/errors.h"
#include "formats/vpl_format.h"

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
  fs::remove(file);  // cutting an old file to 0 makes some file systems write it out at once
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.good()) << file;
}

// Overwrites the bytes of one field.
template <typename T>
void poke(std::string& bytes, size_t offset, const T& value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

// Two rows, every value exact in binary, so that the bytes can be checked by hand.
inline VplTable smallTable(VplStage stage) {
  VplTable table;
  table.stage = stage;
  table.position = {{1.0f, 2.0f, -3.0f}, {0.5f, 0.25f, -0.125f}};
  table.normal = {{0.0f, 0.0f, 1.0f}, {-1.0f, 0.0f, 0.0f}};
  table.albedo = {{0.5f, 0.25f, 0.125f}, {1.0f, 0.0f, 0.75f}};
  table.id = {7, 258};
  table.sceneHash = 0x0123456789abcdefu;
  table.provenance = R"([{"tool":"vpl-place","version":"0.1.0","options":{"seed":1}}])";
  if (stage >= VplStage::Eliminated) {
    table.radius = {0.5f, 1.5f};
    table.rMax = 0.75;
    table.areaEstimate = 12.0;
  }
  if (stage >= VplStage::Lit) {
    table.reach = 2.5;
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
