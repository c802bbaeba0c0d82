#include "formats/shard/shard_file.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/files.h"
#include "core/hash.h"

namespace bnvpl {
namespace {

constexpr size_t kValuesPerBlock = 4096;

// The min number of bytes that hold each of the values with its sign.
uint32_t widthOf(std::span<const int64_t> values) {
  uint64_t used = 0;
  bool negative = false;
  for (const int64_t v : values) {
    used |= static_cast<uint64_t>(v < 0 ? ~v : v);
    negative = negative || v < 0;
  }
  if (used == 0 && !negative) return 0;
  return static_cast<uint32_t>(std::bit_width(used) / 8 + 1);
}

std::string packed(std::span<const int64_t> values, uint32_t width) {
  std::string bytes(values.size() * width, '\0');
  for (size_t i = 0; i < values.size(); ++i)
    std::memcpy(bytes.data() + i * width, &values[i], width);
  return bytes;
}

int64_t unpacked(const char* bytes, uint32_t width) {
  uint64_t value = 0;
  std::memcpy(&value, bytes, width);
  const unsigned unused = 64 - 8 * width;
  return static_cast<int64_t>(value << unused) >> unused;
}

uint64_t hashOf(std::string_view bytes) { return hashPieces({std::as_bytes(std::span(bytes))}); }

uint64_t checksumOf(ShardTrailer trailer, std::span<const ShardBlock> blocks,
                    const std::string& info) {
  trailer.checksum = 0;
  return hashPieces({std::as_bytes(blocks), std::as_bytes(std::span(info)), bytesOf(trailer)});
}

InputError damaged(const fs::path& file, const std::string& what) {
  return {file, what + "; delete it and make it again"};
}

bool isSound(const ShardBlock& block) {
  const bool record = block.kind == kShardRecord && block.width == 1;
  const bool sums = block.kind == kShardSums && block.width <= 8 &&
                    block.count <= kValuesPerBlock && block.index < uint64_t{1} << 62;
  return (record || sums) && block.work.back() == '\0' && block.count < uint64_t{1} << 60;
}

template <typename T>
void readInto(std::ifstream& in, std::span<T> values) {
  if (!values.empty()) {
    in.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size_bytes()));
  }
}

}  // namespace

std::string_view ShardBlock::name() const { return {work.data(), ::strnlen(work.data(), 16)}; }

ShardWriter::ShardWriter(AtomicFile& file) : file_(file), written_(sizeof(ShardHeader)) {
  const ShardHeader header;
  file_.write(bytesOf(header));
}

void ShardWriter::copy(const ShardBlock& block, std::string_view bytes) {
  blocks_.push_back(block);
  if (!bytes.empty()) file_.write(std::as_bytes(std::span(bytes)));
  written_ += bytes.size();
}

void ShardWriter::record(std::string_view work, uint64_t unit, std::string_view bytes) {
  ShardBlock block{{}, kShardRecord, 1, unit, bytes.size(), hashOf(bytes)};
  std::ranges::copy(work, block.work.begin());
  copy(block, bytes);
}

void ShardWriter::sums(std::string_view work, std::span<const int64_t> values) {
  for (size_t begin = 0; begin < values.size(); begin += kValuesPerBlock) {
    const auto some = values.subspan(begin, std::min(kValuesPerBlock, values.size() - begin));
    const uint32_t width = widthOf(some);
    const std::string bytes = packed(some, width);
    ShardBlock block{{}, kShardSums, width, begin, some.size(), hashOf(bytes)};
    std::ranges::copy(work, block.work.begin());
    copy(block, bytes);
  }
}

void ShardWriter::finish(const std::string& info) {
  ShardTrailer trailer;
  trailer.blocks = blocks_.size();
  trailer.infoBytes = info.size();
  trailer.fileBytes =
      written_ + blocks_.size() * sizeof(ShardBlock) + info.size() + sizeof(ShardTrailer);
  trailer.checksum = checksumOf(trailer, blocks_, info);
  file_.write(std::as_bytes(std::span(blocks_)));
  file_.write(info);
  file_.write(bytesOf(trailer));
}

ShardReader::ShardReader(const fs::path& file) : file_(file) {
  if (isRegularFile(file)) in_.open(file, std::ios::binary);
  if (!in_.is_open()) throw InputError(file, "cannot be read as a shard; check the name");
  std::error_code failed;
  const uint64_t size = fs::file_size(file, failed);
  ShardHeader header;
  in_.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in_ || header.magic != ShardHeader{}.magic)
    throw InputError(file, "is no shard; name the files that --shard made");
  if (header.version != kShardVersion) {
    throw InputError(file, "is a shard of version " + std::to_string(header.version) +
                               ", expected " + std::to_string(kShardVersion) +
                               "; make all shards again with this build");
  }
  if (header.reserved != 0) throw damaged(file, "is damaged (its header)");
  ShardTrailer trailer;
  if (failed || size < sizeof header + sizeof trailer) throw damaged(file, "is cut short");
  in_.seekg(static_cast<std::streamoff>(size - sizeof trailer));
  in_.read(reinterpret_cast<char*>(&trailer), sizeof trailer);
  if (!in_ || trailer.endMark != ShardTrailer{}.endMark || trailer.fileBytes != size)
    throw damaged(file, "is cut short or damaged");
  const uint64_t room = size - sizeof header - sizeof trailer;
  if (trailer.blocks > room / sizeof(ShardBlock) ||
      trailer.infoBytes > room - trailer.blocks * sizeof(ShardBlock))
    throw damaged(file, "is damaged (wrong sizes)");
  const uint64_t rest = room - trailer.blocks * sizeof(ShardBlock) - trailer.infoBytes;
  blocks_.resize(trailer.blocks);
  info_.resize(trailer.infoBytes);
  in_.seekg(static_cast<std::streamoff>(sizeof header + rest));
  readInto(in_, std::span(blocks_));
  readInto(in_, std::span(info_));
  if (!in_ || trailer.checksum != checksumOf(trailer, blocks_, info_))
    throw damaged(file, "is damaged (wrong checksum)");
  uint64_t offset = sizeof header;
  for (const ShardBlock& block : blocks_) {
    if (!isSound(block) || block.bytes() > sizeof header + rest - offset)
      throw damaged(file, "is damaged (wrong directory)");
    offsets_.push_back(offset);
    offset += block.bytes();
  }
  if (offset != sizeof header + rest) throw damaged(file, "is damaged (wrong directory)");
}

std::string ShardReader::read(size_t block) {
  return readShardBlock(file_, in_, blocks_[block], offsets_[block]);
}

void ShardReader::addSums(size_t index, std::span<int64_t> all) {
  const ShardBlock& block = blocks_[index];
  if (block.index > all.size() || block.count > all.size() - block.index)
    throw damaged(file_, "has more sums than the others");
  const std::string bytes = read(index);
  for (size_t i = 0; i < block.count && block.width > 0; ++i) {
    int64_t& sum = all[block.index + i];
    if (__builtin_add_overflow(sum, unpacked(bytes.data() + i * block.width, block.width), &sum))
      throw InputError(file_,
                       "its sums and those of other shards exceed 63 bits; give fewer photons");
  }
}

std::string readShardBlock(const fs::path& file, std::ifstream& in, const ShardBlock& block,
                           uint64_t offset) {
  std::string bytes(block.bytes(), '\0');
  in.seekg(static_cast<std::streamoff>(offset));
  readInto(in, std::span(bytes));
  if (!in || block.checksum != hashOf(bytes)) throw damaged(file, "is damaged (wrong checksum)");
  return bytes;
}

}  // namespace bnvpl
