// .shard files, read one at a time as by vpl-merge: an accepted file has the blocks of its
// directory, and the same content after it is merged into a shard again.
//
// The input is read as it is, and a second time with matching checksums and the id of this build in
// place of "@", which mutations would not find.
#include <cstring>

#include "core/hash.h"
#include "formats/vpl/vpl_layout.h"
#include "fuzz/fuzz.h"
#include "tools/common/run/build_id.h"
#include "tools/merge/shard_set.h"

namespace bnvpl {
namespace {

template <typename T>
std::string_view viewOf(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string withBuild(std::string_view info) {
  std::string text(info);
  const std::string_view placeholder = "\"@\"";
  if (const size_t at = text.find(placeholder); at != std::string::npos)
    text.replace(at, placeholder.size(), "\"" + buildId() + "\"");
  return text;
}

// Sets the checksums of all blocks inside the file, then that of the directory.
std::string repaired(std::string_view input) {
  if (input.size() < sizeof(ShardHeader) + sizeof(ShardTrailer)) return {};
  ShardTrailer trailer;
  std::memcpy(&trailer, input.data() + input.size() - sizeof trailer, sizeof trailer);
  const uint64_t room = input.size() - sizeof(ShardHeader) - sizeof trailer;
  trailer.blocks %= room / sizeof(ShardBlock) + 1;
  const uint64_t directory = trailer.blocks * sizeof(ShardBlock);
  trailer.infoBytes %= room - directory + 1;
  const uint64_t rest = room - directory - trailer.infoBytes;
  const std::string content(input.substr(sizeof(ShardHeader), rest));
  std::vector<ShardBlock> blocks(trailer.blocks);
  if (directory > 0)
    std::memcpy(blocks.data(), input.data() + sizeof(ShardHeader) + rest, directory);
  uint64_t offset = 0;
  for (ShardBlock& block : blocks) {
    if (block.width > 8 || block.count > rest || block.bytes() > rest - offset) break;
    block.checksum = hashPieces({std::as_bytes(std::span(content).subspan(offset, block.bytes()))});
    offset += block.bytes();
  }
  const std::string info =
      withBuild(input.substr(sizeof(ShardHeader) + rest + directory, trailer.infoBytes));
  trailer.infoBytes = info.size();
  trailer.endMark = ShardTrailer{}.endMark;
  trailer.fileBytes = sizeof(ShardHeader) + rest + directory + info.size() + sizeof trailer;
  trailer.checksum = 0;
  trailer.checksum = hashPieces(
      {std::as_bytes(std::span(blocks)), std::as_bytes(std::span(info)), bytesOf(trailer)});
  std::string file(viewOf(ShardHeader{}));
  file += content;
  file.append(reinterpret_cast<const char*>(blocks.data()), directory);
  file += info;
  file += viewOf(trailer);
  return file;
}

struct Content {
  std::vector<std::string> records;
  std::vector<int64_t> sums;
  bool operator==(const Content&) const = default;
};

// The records, and the sums of the first block's work.
Content contentOf(ShardSet& shards, const std::vector<ShardBlock>& blocks) {
  Content content;
  size_t sums = 0;
  for (const ShardBlock& block : blocks) {
    if (block.kind == kShardRecord) {
      const auto record = shards.source().record(block.name(), block.index);
      require(record && record->size() == block.count, "a record is as long as its block says");
      content.records.push_back(*record);
    } else if (block.name() == blocks.front().name()) {
      sums += block.count;
    }
  }
  if (sums > 0) content.sums = shards.source().sums(blocks.front().name(), sums);
  return content;
}

void readAndMerge(const InputFolder& folder, const fs::path& file) {
  std::vector<ShardBlock> blocks;
  if (!accepted([&] {
        const ShardReader reader(file);
        blocks.assign(reader.blocks().begin(), reader.blocks().end());
      })) {
    return;
  }
  const fs::path merged = folder.at("merged.shard");
  Content before, after;
  if (!accepted([&] {
        ShardSet shards({file});
        before = contentOf(shards, blocks);
        shards.verifyRest();
        AtomicFile output(merged);
        shards.writeTo(output);
        output.commit();
      })) {
    return;
  }
  ShardSet again({merged});
  after = contentOf(again, blocks);
  require(before == after, "a merged shard holds what its parts held");
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  readAndMerge(folder, folder.write("in.shard", input));
  readAndMerge(folder, folder.write("repaired.shard", repaired(input)));
  return 0;
}
