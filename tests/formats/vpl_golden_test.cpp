// Pins the bytes of version 5 of the format: any change here requires a new version.
#include <sstream>

#include "formats/vpl/vpl_io.h"
#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

// smallTable(VplStage::Lit) with 16 bytes per line; lines of zeros are left out.
constexpr size_t kLitBytes = 1608;
constexpr const char* kLitDump = R"(
0000: 89 56 50 4c 0d 0a 1a 0a 05 00 00 00 03 00 00 00
0010: 02 00 00 00 00 00 00 00 ef cd ab 89 67 45 23 01
0020: 3d 00 00 00 00 00 00 00 48 06 00 00 00 00 00 00
0030: 30 a2 21 0c 72 b0 4f dd 0b 00 00 00 00 00 00 00
0040: 00 00 00 00 00 00 e8 3f 00 00 00 00 00 00 28 40
0050: 00 00 00 00 00 00 04 40 00 00 00 00 00 00 e4 3f
0080: 70 6f 73 69 74 69 6f 6e 00 00 00 00 00 00 00 00
0090: 00 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
00a0: 80 03 00 00 00 00 00 00 18 00 00 00 00 00 00 00
00b0: 73 63 65 6e 65 20 75 6e 69 74 00 00 00 00 00 00
00c0: 6e 6f 72 6d 61 6c 00 00 00 00 00 00 00 00 00 00
00d0: 00 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
00e0: c0 03 00 00 00 00 00 00 18 00 00 00 00 00 00 00
00f0: 31 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0100: 61 6c 62 65 64 6f 00 00 00 00 00 00 00 00 00 00
0110: 00 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
0120: 00 04 00 00 00 00 00 00 18 00 00 00 00 00 00 00
0130: 31 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0140: 69 64 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0150: 00 00 00 00 00 00 00 00 02 00 00 00 01 00 00 00
0160: 40 04 00 00 00 00 00 00 08 00 00 00 00 00 00 00
0170: 2d 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0180: 72 61 64 69 75 73 00 00 00 00 00 00 00 00 00 00
0190: 00 00 00 00 00 00 00 00 01 00 00 00 01 00 00 00
01a0: 80 04 00 00 00 00 00 00 08 00 00 00 00 00 00 00
01b0: 73 63 65 6e 65 20 75 6e 69 74 00 00 00 00 00 00
01c0: 66 6c 75 78 00 00 00 00 00 00 00 00 00 00 00 00
01d0: 00 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
01e0: c0 04 00 00 00 00 00 00 18 00 00 00 00 00 00 00
01f0: 57 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0200: 70 68 6f 74 6f 6e 73 00 00 00 00 00 00 00 00 00
0210: 00 00 00 00 00 00 00 00 03 00 00 00 01 00 00 00
0220: 00 05 00 00 00 00 00 00 10 00 00 00 00 00 00 00
0230: 31 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0240: 72 65 6c 61 74 69 76 65 5f 65 72 72 6f 72 00 00
0250: 00 00 00 00 00 00 00 00 01 00 00 00 01 00 00 00
0260: 40 05 00 00 00 00 00 00 08 00 00 00 00 00 00 00
0270: 31 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0280: 65 6d 69 74 5f 70 6f 73 69 74 69 6f 6e 00 00 00
0290: 00 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
02a0: 80 05 00 00 00 00 00 00 18 00 00 00 00 00 00 00
02b0: 73 63 65 6e 65 20 75 6e 69 74 00 00 00 00 00 00
02c0: 65 6d 69 74 5f 6e 6f 72 6d 61 6c 00 00 00 00 00
02d0: 00 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
02e0: c0 05 00 00 00 00 00 00 18 00 00 00 00 00 00 00
02f0: 31 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0300: 66 69 72 73 74 5f 62 6f 75 6e 63 65 5f 66 6c 75
0310: 78 00 00 00 00 00 00 00 01 00 00 00 03 00 00 00
0320: 00 06 00 00 00 00 00 00 18 00 00 00 00 00 00 00
0330: 57 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00
0340: 5b 7b 22 74 6f 6f 6c 22 3a 22 76 70 6c 2d 70 6c
0350: 61 63 65 22 2c 22 76 65 72 73 69 6f 6e 22 3a 22
0360: 30 2e 31 2e 30 22 2c 22 6f 70 74 69 6f 6e 73 22
0370: 3a 7b 22 73 65 65 64 22 3a 31 7d 7d 5d 00 00 00
0380: 00 00 80 3f 00 00 00 40 00 00 40 c0 00 00 00 3f
0390: 00 00 80 3e 00 00 00 be 00 00 00 00 00 00 00 00
03c0: 00 00 00 00 00 00 00 00 00 00 80 3f 00 00 80 bf
0400: 00 00 00 3f 00 00 80 3e 00 00 00 3e 00 00 80 3f
0410: 00 00 00 00 00 00 40 3f 00 00 00 00 00 00 00 00
0440: 07 00 00 00 02 01 00 00 00 00 00 00 00 00 00 00
0480: 00 00 00 3f 00 00 c0 3f 00 00 00 00 00 00 00 00
04c0: 00 00 80 3f 00 00 00 40 00 00 80 40 00 00 00 00
0500: 01 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00
0540: 00 00 80 3d 00 00 00 00 00 00 00 00 00 00 00 00
0580: 00 00 80 3f 00 00 10 40 00 00 40 c0 00 00 00 3f
0590: 00 00 80 3e 00 00 00 be 00 00 00 00 00 00 00 00
05c0: 00 00 00 00 00 00 80 3f 00 00 00 00 00 00 80 bf
0600: 00 00 00 3f 00 00 00 40 00 00 00 00 00 00 00 00
0640: 56 50 4c 2d 45 4e 44 0a
)";

std::string fromDump(const char* dump, size_t size) {
  std::string bytes(size, '\0');
  std::istringstream lines(dump);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    size_t offset = 0;
    char colon = 0;
    if (!(words >> std::hex >> offset >> colon)) continue;
    for (unsigned value = 0; words >> value;) bytes.at(offset++) = static_cast<char>(value);
  }
  return bytes;
}

class VplGolden : public TestFolder, public ::testing::WithParamInterface<VplStage> {
 protected:
  fs::path golden() const {
    return fs::path(BNVPL_GOLDEN_DIR) / (std::string(stageName(GetParam())) + ".vpl");
  }
};
INSTANTIATE_TEST_SUITE_P(Stages, VplGolden,
                         ::testing::Values(VplStage::Candidates, VplStage::Eliminated,
                                           VplStage::Lit),
                         [](const auto& stage) { return std::string(stageName(stage.param)); });

TEST_F(TestFolder, WriterMakesThePinnedBytes) {
  writeVpl(at("lit.vpl"), smallTable(VplStage::Lit));
  const std::string written = readAll(at("lit.vpl")), pinned = fromDump(kLitDump, kLitBytes);
  ASSERT_EQ(written.size(), pinned.size());
  for (size_t i = 0; i < pinned.size(); ++i) ASSERT_EQ(written[i], pinned[i]) << "byte " << i;
}

TEST_P(VplGolden, WriterMakesTheCommittedFile) {
  writeVpl(at("written.vpl"), smallTable(GetParam()));
  EXPECT_TRUE(readAll(at("written.vpl")) == readAll(golden()));
}

TEST_P(VplGolden, ReaderReadsTheCommittedFile) {
  expectSame(readVpl(golden(), GetParam()), smallTable(GetParam()));
}

// Extra columns of methods follow the columns of the stage.
TEST_F(TestFolder, AFileWithMethodsColumnsIsPinned) {
  const fs::path golden = fs::path(BNVPL_GOLDEN_DIR) / "methods.vpl";
  VplTable table = smallTable(VplStage::Eliminated);
  table.extras = someExtras(2);
  expectSame(readVpl(golden), table);
  writeVpl(at("written.vpl"), table);
  EXPECT_TRUE(readAll(at("written.vpl")) == readAll(golden));
}

}  // namespace
}  // namespace bnvpl
