// Extra columns of methods survive a round trip, and inconsistent ones are refused.
#include <xxhash.h>

#include <limits>

#include "formats/vpl/vpl_io.h"
#include "formats/vpl/vpl_layout.h"
#include "tests/formats/test_files.h"
#include "tests/support/messages.h"

namespace bnvpl {
namespace {

constexpr size_t kStandard = 5;  // columns of stage Eliminated
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class VplExtras : public TestFolder {
 protected:
  VplExtras() : table_(smallTable(VplStage::Eliminated)) {
    table_.extras = someExtras(2);
    writeVpl(at("good.vpl"), table_);
    good_ = readAll(at("good.vpl"));
  }
  static size_t entry(size_t extra, size_t field) {
    return sizeof(VplHeader) + (kStandard + extra) * sizeof(VplColumnEntry) + field;
  }
  // The reader's error message when `value` stands at `offset` and the checksum is right.
  template <typename T>
  std::string complaintAbout(size_t offset, const T& value) const {
    std::string bytes = good_;
    poke(bytes, offset, value);
    return complaint(bytes);
  }
  std::string complaint(std::string bytes) const {
    poke(bytes, offsetof(VplHeader, checksum), uint64_t{0});
    poke(bytes, offsetof(VplHeader, checksum), XXH3_64bits(bytes.data(), bytes.size()));
    writeAll(at("bad.vpl"), bytes);
    try {
      readVpl(at("bad.vpl"));
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }
  // The writer's error message for a table with this column appended.
  std::string refusal(const VplExtraColumn& column) const {
    VplTable table = table_;
    table.extras.push_back(column);
    try {
      writeVpl(at("a.vpl"), table);
    } catch (const std::logic_error& error) {
      EXPECT_FALSE(fs::exists(at("a.vpl")));
      return error.what();
    }
    fs::remove(at("a.vpl"));
    return {};
  }
  uint64_t columnOffset(size_t extra) const {
    uint64_t offset = 0;
    std::memcpy(&offset, good_.data() + entry(extra, offsetof(VplColumnEntry, offset)), 8);
    return offset;
  }

  VplTable table_;
  std::string good_;
};

TEST_F(VplExtras, EveryStageAndSizeSurvivesTheRoundTrip) {
  for (const VplStage stage : {VplStage::Candidates, VplStage::Eliminated, VplStage::Lit}) {
    for (const size_t count : {0, 1, 17, 300}) {
      VplTable table = validRows(stage, count);
      table.provenance = "[]";
      table.extras = someExtras(count);
      writeVpl(at("a.vpl"), table);
      expectSame(readVpl(at("a.vpl"), stage), table);
    }
  }
}

TEST_F(VplExtras, TheLargestThatAreAllowed) {
  VplTable table = smallTable(VplStage::Candidates);
  for (size_t i = 0; i < kMaxExtraColumns; ++i) {
    table.extras.push_back({"a.name-of-23-bytes-" + std::to_string(1000 + i), "15 bytes a unit", 1,
                            std::vector<uint32_t>(2, 5)});
  }
  table.extras[7].components = kMaxExtraComponents;
  table.extras[7].values = std::vector<float>(2 * kMaxExtraComponents, 0.5f);
  writeVpl(at("a.vpl"), table);
  expectSame(readVpl(at("a.vpl")), table);
  table.extras.push_back({"a.more", "1", 1, std::vector<float>(2)});
  EXPECT_THROW(writeVpl(at("b.vpl"), table), std::logic_error);
}

TEST_F(VplExtras, TheWriterRefusesWhatTheReaderWould) {
  const std::vector<float> two(2);
  EXPECT_EQ(refusal({"ward.order", "1", 1, two}), "");
  for (const char* name : {"", "lobes", ".lobes", "rich.", "rich.a.b", "Rich.lobes", "rich.l s",
                           "rich.l\xc3\xbc", "rich.,", "rich.twentyfour-bytes-xx"}) {
    EXPECT_SAYS(refusal({name, "1", 1, two}), "needs a name such as rich.lobes");
  }
  EXPECT_SAYS(refusal({"rich.lobes", "1", 1, two}), "a second column rich.lobes");
  EXPECT_SAYS(refusal({"rich.x", "1", 0, {}}), "column rich.x has 0 components, not 1 to 1024");
  EXPECT_SAYS(refusal({"rich.x", "1", 1025, std::vector<float>(2050)}), "1025 components");
  for (const char* unit : {"", "sixteen bytes xx", "\n", "\xc2\xb5"})
    EXPECT_SAYS(refusal({"rich.x", unit, 1, two}), "the unit of column rich.x is not 1 to 15");
  EXPECT_SAYS(refusal({"rich.x", "1", 2, two}), "rich.x has 8 bytes, expected 2 rows of 8");
  EXPECT_SAYS(refusal({"rich.x", "1", 2, std::vector<float>{0, 0, 0, kNan}}),
              "column rich.x, row 1: not a finite number");
}

TEST_F(VplExtras, EveryFieldOfTheDirectoryIsChecked) {
  ASSERT_EQ(complaint(good_), "");
  const auto at = [](size_t extra, size_t field) {
    return "byte " + std::to_string(entry(extra, field)) + ": ";
  };
  const auto bad = [&](size_t extra, size_t field, const auto& value, const std::string& what) {
    EXPECT_SAYS(complaintAbout(entry(extra, field), value), at(extra, field) + what);
  };
  bad(0, 0, 'R', "a method's column needs a name");
  bad(0, 0, '\0', "a method's column needs a name");
  bad(2, 0, std::array{'r', 'i', 'c', 'h', '.', 'l', 'o', 'b', 'e', 's'}, "a second column");
  std::array<char, 24> unended{};
  unended.fill('a');
  unended[3] = '.';
  bad(0, 0, unended, "a method's column needs a name");
  EXPECT_SAYS(complaintAbout(entry(0, 15), 'x'), at(0, 0) + "name or unit of column rich.lobes");
  EXPECT_SAYS(complaintAbout(entry(0, 60), 'x'), at(0, 0) + "name or unit of column rich.lobes");
  for (const uint32_t type : {0u, 4u, ~0u})
    bad(1, 24, type, "unknown type " + std::to_string(type));
  for (const uint32_t components : {0u, 1025u, 0x40000001u, ~0u})
    bad(1, 28, components, "column light-slice.cluster has " + std::to_string(components));
  bad(1, 48, '\0', "the unit of column light-slice.cluster");
  bad(1, 48, '\x1b', "the unit of column light-slice.cluster");
  // Another type or width of the same size has the same layout; the file is valid.
  EXPECT_EQ(complaintAbout(entry(1, 24), 1u), "");
  EXPECT_SAYS(complaintAbout(entry(0, 28), 5u),
              at(0, 40) + "bytes of column rich.lobes 32, expected 40");
}

TEST_F(VplExtras, ColumnsAreContiguous) {
  const auto offsetField = [](size_t extra) { return entry(extra, 32); };
  for (const uint64_t offset :
       {uint64_t{0}, columnOffset(0), columnOffset(1) + 4, columnOffset(2), ~uint64_t{0}}) {
    if (offset == columnOffset(1)) continue;
    EXPECT_SAYS(
        complaintAbout(offsetField(1), offset),
        "byte " + std::to_string(offsetField(1)) + ": offset of column light-slice.cluster");
  }
  for (const uint64_t bytes : {uint64_t{0}, uint64_t{7}, uint64_t{64}, ~uint64_t{0}}) {
    EXPECT_SAYS(complaintAbout(entry(1, 40), bytes),
                "byte " + std::to_string(entry(1, 40)) + ": bytes of column light-slice.cluster");
  }
  // With one column fewer in the header, the provenance would begin in the last column's entry.
  EXPECT_NE(complaintAbout(56, static_cast<uint32_t>(kStandard + 2)), "");
  EXPECT_SAYS(complaintAbout(28 + entry(1, 0), 1024u), "byte 16: 2 rows");
}

TEST_F(VplExtras, ValuesAndPaddingAreChecked) {
  EXPECT_SAYS(complaintAbout(columnOffset(0) + 20, kNan),
              "byte " + std::to_string(columnOffset(0) + 16) +
                  ": column rich.lobes, row 1: not a finite number");
  EXPECT_SAYS(complaintAbout(columnOffset(1) + 8, '\1'),
              "byte " + std::to_string(columnOffset(1) + 8) + ": padding");
}

TEST_F(VplExtras, EverySingleBitFlipIsRefused) {
  for (size_t i = 0; i < good_.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good_;
      bytes[i] = static_cast<char>(bytes[i] ^ (1 << bit));
      writeAll(at("bad.vpl"), bytes);
      ASSERT_THROW(readVpl(at("bad.vpl")), FileError) << "byte " << i << " bit " << bit;
    }
  }
}

}  // namespace
}  // namespace bnvpl
