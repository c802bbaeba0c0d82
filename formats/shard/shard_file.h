// .shard: the results of a shard of a stage's work. The bytes on disk, little-endian:
//
//     0  ShardHeader, 16 bytes
//    16  blocks, one after the other
//     .  directory: one ShardBlock for each block
//     .  info: UTF-8 JSON that identifies the work and the part; formats/README.md, "Shards"
//   end  ShardTrailer, 48 bytes
//
// A block is the record of one unit, or a range of the sums over all units, packed to their width.
// Files are written and merged sequentially, block by block.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "formats/atomic_file.h"

namespace bnvpl {

inline constexpr uint32_t kShardVersion = 1;

struct ShardHeader {
  std::array<char, 8> magic{'\x89', 'V', 'P', 'L', 'S', 'H', 'D', '\n'};
  uint32_t version = kShardVersion;
  uint32_t reserved = 0;
};
static_assert(sizeof(ShardHeader) == 16);

struct ShardBlock {
  std::array<char, 16> work{};  // name of the kind of work, zero-padded
  uint32_t kind = 0;            // 1: record, 2: sums
  uint32_t width = 0;           // bytes per value: 1 in records, 0 to 8 in sums, sign-extended
  uint64_t index = 0;           // the unit, or the index of the first sum
  uint64_t count = 0;           // number of values
  uint64_t checksum = 0;        // XXH3-64 of the block's bytes

  std::string_view name() const;
  uint64_t bytes() const { return count * width; }
};
static_assert(sizeof(ShardBlock) == 48);
inline constexpr uint32_t kShardRecord = 1, kShardSums = 2;

struct ShardTrailer {
  uint64_t blocks = 0;
  uint64_t infoBytes = 0;
  uint64_t fileBytes = 0;
  uint64_t checksum = 0;  // XXH3-64 of directory, info and trailer with this field taken as zero
  uint64_t reserved = 0;
  std::array<char, 8> endMark{'S', 'H', 'D', '-', 'E', 'N', 'D', '\n'};
};
static_assert(sizeof(ShardTrailer) == 48);

class ShardWriter {
 public:
  explicit ShardWriter(AtomicFile& file);
  void record(std::string_view work, uint64_t unit, std::string_view bytes);
  void sums(std::string_view work, std::span<const int64_t> values);
  void copy(const ShardBlock& block, std::string_view bytes);
  // Ends the file, which the caller commits.
  void finish(const std::string& info);

 private:
  AtomicFile& file_;
  std::vector<ShardBlock> blocks_;
  uint64_t written_;
};

// An open file. The constructor verifies directory and info; blocks are verified as they are read.
class ShardReader {
 public:
  // Throws InputError if the file is no shard, damaged, cut short or of another version.
  explicit ShardReader(const fs::path& file);

  const std::string& info() const { return info_; }
  std::span<const ShardBlock> blocks() const { return blocks_; }
  uint64_t offsetOf(size_t block) const { return offsets_[block]; }
  std::string read(size_t block);
  void addSums(size_t block, std::span<int64_t> all);  // adds the block's sums to those in `all`

 private:
  fs::path file_;
  std::ifstream in_;
  std::vector<ShardBlock> blocks_;
  std::vector<uint64_t> offsets_;
  std::string info_;
};

// Reads the bytes of a block at `offset` of an open file. Throws InputError if they are damaged.
std::string readShardBlock(const fs::path& file, std::ifstream& in, const ShardBlock& block,
                           uint64_t offset);

}  // namespace bnvpl
