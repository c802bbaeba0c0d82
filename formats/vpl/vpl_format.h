// .vpl: the bytes on disk, little-endian. Any change except an extra column bumps kVplVersion.
// formats/README.md explains the format; vpl_columns.h has the columns.
//
//     0  VplHeader, 128 bytes
//   128  directory: columnCount entries of 64 bytes
//     .  provenance: UTF-8 JSON array, oldest stage first, zero-padded to 64
//     .  columns in the order of the directory, `count` rows each, zero-padded to 64
//   end  kVplEndMark: without it the file was cut short
//
// A file has the columns of its stage and of all stages before it, in the order of kVplColumns, and
// then the extra columns that methods of stages have added.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "formats/vpl/vpl_columns.h"
#include "formats/vpl/vpl_table.h"

namespace bnvpl {

inline constexpr uint32_t kVplVersion = 5;
inline constexpr uint64_t kVplAlign = 64;
inline constexpr size_t kMaxExtraColumns = 256;        // max number in a file
inline constexpr uint32_t kMaxExtraComponents = 1024;  // max number per extra column
// A byte with the high bit set, both line endings and the DOS end-of-file: any copy in text mode
// breaks one of them.
inline constexpr std::array<char, 8> kVplMagic{'\x89', 'V', 'P', 'L', '\r', '\n', '\x1a', '\n'};
inline constexpr std::array<char, 8> kVplEndMark{'V', 'P', 'L', '-', 'E', 'N', 'D', '\n'};

struct VplHeader {
  std::array<char, 8> magic = kVplMagic;
  uint32_t version = kVplVersion;
  VplStage stage = VplStage::Candidates;
  uint64_t count = 0;            // number of rows of every column
  uint64_t sceneHash = 0;        // content hash; a mismatch means that the scene is another one
  uint64_t provenanceBytes = 0;  // without the padding
  uint64_t fileBytes = 0;        // size of the whole file, including the end mark
  uint64_t checksum = 0;         // XXH3-64 of the whole file with this field taken as zero
  uint32_t columnCount = 0;
  uint32_t rowKind = 0;             // 0: points; readers refuse anything else
  double rMax = 0.0;                // scene units; 0 until known
  double areaEstimate = 0.0;        // scene units squared; 0 until known
  double reach = 0.0;               // distance within which VPLs received photons, in radii
  double indirectShare = 1.0;       // VplTable::indirectShare
  std::array<char, 32> reserved{};  // zero; readers refuse anything else
};
static_assert(sizeof(VplHeader) == 128 && std::is_trivially_copyable_v<VplHeader>);
static_assert(offsetof(VplHeader, version) == 8 && offsetof(VplHeader, stage) == 12);
static_assert(offsetof(VplHeader, count) == 16 && offsetof(VplHeader, sceneHash) == 24);
static_assert(offsetof(VplHeader, provenanceBytes) == 32 && offsetof(VplHeader, fileBytes) == 40);
static_assert(offsetof(VplHeader, checksum) == 48 && offsetof(VplHeader, columnCount) == 56);
static_assert(offsetof(VplHeader, indirectShare) == 88 && offsetof(VplHeader, reserved) == 96);
static_assert(offsetof(VplHeader, rowKind) == 60 && offsetof(VplHeader, rMax) == 64);
static_assert(offsetof(VplHeader, areaEstimate) == 72 && offsetof(VplHeader, reach) == 80);

struct VplColumnEntry {
  std::array<char, 24> name;  // zero-padded, with at least one zero
  VplType type;
  uint32_t components;
  uint64_t offset;            // from the start of the file, a multiple of kVplAlign
  uint64_t bytes;             // count * components * size of type, without the padding
  std::array<char, 16> unit;  // zero-padded, with at least one zero
};
static_assert(sizeof(VplColumnEntry) == 64 && std::is_trivially_copyable_v<VplColumnEntry>);
static_assert(offsetof(VplColumnEntry, type) == 24 && offsetof(VplColumnEntry, components) == 28);
static_assert(offsetof(VplColumnEntry, offset) == 32 && offsetof(VplColumnEntry, bytes) == 40);
static_assert(offsetof(VplColumnEntry, unit) == 48);
static_assert(std::all_of(kVplColumns.begin(), kVplColumns.end(), [](const VplColumn& column) {
  return column.name.size() < sizeof(VplColumnEntry::name) &&
         column.unit.size() < sizeof(VplColumnEntry::unit);
}));

static_assert(std::endian::native == std::endian::little, "add byte swapping");

}  // namespace bnvpl
