// Any damage to a file is reported with the right byte offset before anything is allocated.
#include <xxhash.h>

#include <limits>

#include "formats/vpl/vpl_io.h"
#include "tests/formats/test_files.h"
#include "tests/support/messages.h"

namespace bnvpl {
namespace {

class VplDamage : public TestFolder {
 protected:
  VplDamage() {
    writeVpl(at("good.vpl"), smallTable(VplStage::Lit));
    good_ = readAll(at("good.vpl"));
  }
  // The reader's error message for these bytes; empty when it accepts them.
  std::string complaint(const std::string& bytes) const {
    writeAll(at("bad.vpl"), bytes);
    try {
      readVpl(at("bad.vpl"));
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }
  // The error message after the checksum has been recomputed for the damaged bytes.
  std::string complaintDespiteChecksum(std::string bytes) const {
    poke(bytes, offsetof(VplHeader, checksum), uint64_t{0});
    poke(bytes, offsetof(VplHeader, checksum), XXH3_64bits(bytes.data(), bytes.size()));
    return complaint(bytes);
  }
  template <typename T>
  std::string complaintAbout(size_t offset, T value) const {
    std::string bytes = good_;
    poke(bytes, offset, value);
    return complaintDespiteChecksum(bytes);
  }
  uint64_t columnOffset(size_t column) const {
    VplColumnEntry entry;
    std::memcpy(&entry, good_.data() + sizeof(VplHeader) + column * sizeof(entry), sizeof(entry));
    return entry.offset;
  }

  std::string good_;
};

TEST_F(VplDamage, ChecksumIsPlainXxh3OfTheFile) {
  EXPECT_EQ(complaintDespiteChecksum(good_), "");
  writeAll(at("bad.vpl"), good_);
  EXPECT_EQ(complaint(good_), "");
}

TEST_F(VplDamage, EveryTruncationIsRefusedWhereItEnds) {
  for (size_t size = 0; size < good_.size(); ++size) {
    ASSERT_PRED2(contains, complaint(good_.substr(0, size)),
                 "byte " + std::to_string(size) + ": cut");
  }
}

TEST_F(VplDamage, BytesAfterTheEndAreRefused) {
  EXPECT_SAYS(complaint(good_ + '\0'), "byte 1608: bytes after the end");
  EXPECT_SAYS(complaint(good_ + good_), "byte 1608: bytes after the end");
}

TEST_F(VplDamage, EverySingleBitFlipIsRefused) {
  for (size_t i = 0; i < good_.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good_;
      bytes[i] = static_cast<char>(bytes[i] ^ (1 << bit));
      ASSERT_NE(complaint(bytes), "") << "byte " << i << " bit " << bit;
    }
  }
}

TEST_F(VplDamage, EachHeaderFieldIsCheckedBehindTheChecksum) {
  EXPECT_SAYS(complaintAbout(0, 'x'), "byte 0: not a .vpl file");
  EXPECT_SAYS(complaintAbout(8, 4u), "byte 8: version 4, expected 5; rerun vpl-place and every");
  EXPECT_SAYS(complaintAbout(8, 6u), "byte 8: version 6, expected 5; use the bnvpl that wrote it");
  EXPECT_SAYS(complaintAbout(8, 0u), "byte 8: version 0");
  EXPECT_SAYS(complaintAbout(12, 0u), "byte 12: unknown stage 0");
  EXPECT_SAYS(complaintAbout(12, 4u), "byte 12: unknown stage 4");
  EXPECT_SAYS(complaintAbout(12, 2u), "byte 448: a method's column needs a name");
  EXPECT_SAYS(complaintAbout(32, uint64_t{200}), "byte 16: 2 rows make a file of");
  EXPECT_SAYS(complaintAbout(32, ~uint64_t{0}), "byte 32: provenance does not fit");
  EXPECT_SAYS(complaintAbout(40, uint64_t{1607}), "byte 1607: bytes after the end");
  EXPECT_SAYS(complaintAbout(40, uint64_t{1609}), "byte 1608: cut short");
  EXPECT_SAYS(complaintAbout(40, ~uint64_t{0}), "byte 1608: cut short");
  EXPECT_SAYS(complaintAbout(56, 7u), "byte 56: 7 columns");
  EXPECT_SAYS(complaintAbout(56, 12u), "byte 856: unknown type");
  EXPECT_SAYS(complaintAbout(56, 24u), "byte 56: 24 columns do not fit into the file");
  EXPECT_SAYS(complaintAbout(56, 11u + 257), "byte 56: 268 columns, a file of stage lit has 11");
  EXPECT_SAYS(complaintAbout(56, ~0u), "byte 56: 4294967295 columns");
  EXPECT_SAYS(complaintAbout(60, 1u), "byte 60: row kind 1, this build knows 0, points");
  EXPECT_SAYS(complaintAbout(64, -1.0), "byte 64: r_max");
  EXPECT_SAYS(complaintAbout(64, std::numeric_limits<double>::quiet_NaN()), "byte 64: r_max");
  EXPECT_SAYS(complaintAbout(72, std::numeric_limits<double>::infinity()), "byte 72: area");
  for (const double share : {-0.25, 1.5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_SAYS(complaintAbout(88, share), "byte 88: share of indirect light is not 0 to 1");
  for (size_t i = 96; i < 128; ++i) EXPECT_SAYS(complaintAbout(i, '\1'), "byte 96: reserved");
  EXPECT_SAYS(complaintAbout(80, -1.0), "byte 80: reach");
}

TEST_F(VplDamage, SceneHashAndChecksumAreCoveredByTheChecksum) {
  for (const size_t offset : {24, 48}) {
    std::string bytes = good_;
    poke(bytes, offset, uint64_t{1});
    EXPECT_SAYS(complaint(bytes), "byte 48: checksum does not match");
  }
}

TEST_F(VplDamage, NoClaimedCountIsAllocatedOrOverflows) {
  const uint64_t rows = 68;  // bytes of a row of stage Lit
  for (const uint64_t count :
       {uint64_t{1} << 40, ~uint64_t{0}, ~uint64_t{0} / rows + 1, ~uint64_t{0} / 12 + 2,
        (uint64_t{1} << 62) + 2, (uint64_t{1} << 61) + 2, uint64_t{1} << 63}) {
    EXPECT_SAYS(complaintAbout(16, count),
                "byte 16: " + std::to_string(count) + " rows do not fit");
  }
  // Thanks to the padding, a file with one row less has the same size; the directory reveals it.
  EXPECT_SAYS(complaintAbout(16, uint64_t{1}), "byte 128: directory entry");
  EXPECT_SAYS(complaintAbout(16, uint64_t{6}), "byte 16: 6 rows make a file of");
}

TEST_F(VplDamage, TextModeCopiesHaveTheirOwnMessage) {
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string bytes = good_;
    for (size_t i = 0; (i = bytes.find(from, i)) != std::string::npos; i += to.size()) {
      bytes.replace(i, from.size(), to);
    }
    return bytes;
  };
  EXPECT_SAYS(complaint(replaced("\r\n", "\n")), "text mode");
  EXPECT_SAYS(complaint(replaced("\n", "\r\n")), "text mode");
  std::string sevenBits = good_;
  for (char& c : sevenBits) c = static_cast<char>(c & 0x7f);
  EXPECT_SAYS(complaint(sevenBits), "text mode");
  EXPECT_SAYS(complaint("[film]\nwidth = 832\n"), "not a .vpl file");
}

TEST_F(VplDamage, TheDirectoryMustBeTheWriters) {
  for (size_t i = sizeof(VplHeader); i < 832; ++i) {
    const size_t entry = (i - sizeof(VplHeader)) / 64;
    const char changed = static_cast<char>(good_[i] ^ 1);
    ASSERT_PRED2(contains, complaintAbout(i, changed),
                 "byte " + std::to_string(128 + 64 * entry) + ": directory entry");
  }
}

TEST_F(VplDamage, PaddingAndEndMarkAreChecked) {
  EXPECT_SAYS(complaintAbout(832 + 61, '\1'), "byte 893: padding");
  EXPECT_SAYS(complaintAbout(columnOffset(0) + 24, '\1'), "byte 920: padding");
  EXPECT_SAYS(complaintAbout(columnOffset(10) + 63, '\1'), "byte 1599: padding");
  EXPECT_SAYS(complaintAbout(1600, 'v'), "byte 1600: no end mark");
}

TEST_F(VplDamage, WrongValuesAreRefusedAtTheirByte) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto at = [&](size_t column, size_t row, size_t component) {
    return columnOffset(column) + 4 * (3 * row + component);
  };
  EXPECT_SAYS(complaintAbout(at(0, 1, 0), nan), "byte 908: column position, row 1: not a finite");
  EXPECT_SAYS(complaintAbout(at(1, 0, 2), 1.5f), "column normal, row 0: not of unit length");
  EXPECT_SAYS(complaintAbout(at(2, 1, 2), 1.5f), "column albedo, row 1: not between");
  EXPECT_SAYS(complaintAbout(columnOffset(4) + 4, 0.0f), "column radius, row 1: not above 0");
  EXPECT_SAYS(complaintAbout(columnOffset(4) + 4, 3e38f),
              "column radius, row 1: larger than any scene");
  EXPECT_SAYS(complaintAbout(at(5, 0, 0), -1.0f), "column flux, row 0: negative");
  EXPECT_SAYS(complaintAbout(columnOffset(7), nan), "column relative_error, row 0: not a finite");
  EXPECT_SAYS(complaintAbout(at(10, 1, 2), -1.0f), "column first_bounce_flux, row 1: negative");
  EXPECT_SAYS(complaintAbout(at(10, 0, 0), 1.5f),
              "column first_bounce_flux, row 0: above the flux");
  EXPECT_EQ(complaintAbout(at(2, 0, 0), 1.00005f), "");  // within the tolerance
}

TEST_F(VplDamage, ProvenanceMustBeAJsonArrayOfObjects) {
  EXPECT_SAYS(complaintAbout(832, '{'), "byte 832: provenance");
  EXPECT_SAYS(complaintAbout(833, '\0'), "byte 832: provenance");
  EXPECT_SAYS(complaintAbout(836, '\xff'), "byte 832: provenance");       // not UTF-8
  EXPECT_SAYS(complaintAbout(32, uint64_t{62}), "byte 832: provenance");  // a zero inside the text
  EXPECT_SAYS(complaintAbout(32, uint64_t{60}), "byte 892: padding");
}

TEST_F(VplDamage, FilesThatAreNoFilesAreRefused) {
  EXPECT_THROW(readVpl(at("missing.vpl")), InputError);
  EXPECT_THROW(readVpl(at(".")), InputError);
  EXPECT_THROW(readVpl("/dev/zero"), InputError);
}

TEST_F(VplDamage, HeaderAloneIsReadWithoutTheContent) {
  std::string bytes = good_;
  bytes[900] = 'x';
  writeAll(at("bad.vpl"), bytes);
  EXPECT_EQ(readVplHeader(at("bad.vpl")).count, 2u);
  EXPECT_THROW(readVpl(at("bad.vpl")), FileError);
  // The wrong stage is reported first, since another copy of the file would not help.
  EXPECT_THROW(readVpl(at("bad.vpl"), VplStage::Candidates), InputError);
}

}  // namespace
}  // namespace bnvpl
