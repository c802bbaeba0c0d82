#include "formats/shard/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "core/files.h"
#include "core/hash.h"
#include "formats/atomic_file.h"

namespace bnvpl {
namespace {

uint64_t checksumOf(CheckpointHeader header, const std::string& run, const std::string& state) {
  header.checksum = 0;
  return hashPieces(
      {bytesOf(header), std::as_bytes(std::span(run)), std::as_bytes(std::span(state))});
}

constexpr const char* kNone = "is no checkpoint; name another file, or, if it was one, delete it";

}  // namespace

std::optional<bool> beginsAsCheckpoint(const fs::path& file) {
  std::array<char, 8> start{};
  std::ifstream in;
  if (isRegularFile(file)) in.open(file, std::ios::binary);
  if (!in.is_open()) return std::nullopt;
  in.read(start.data(), start.size());
  return start == CheckpointHeader{}.magic;
}

std::optional<CheckpointFile> findCheckpoint(const fs::path& file) {
  const auto damaged = [&](const std::string& what) {
    return InputError(file, what + "; delete it and start again");
  };
  std::ifstream in(file, std::ios::binary);
  CheckpointHeader header;
  if (!in && errno == ENOENT) return std::nullopt;
  if (!in) throw InputError(file, "cannot be read as a checkpoint; is it readable?");
  // The size of what is open, for the name may have gone or got another file meanwhile.
  in.seekg(0, std::ios::end);
  const auto size = static_cast<uint64_t>(in.tellg());
  in.seekg(0);
  if (!in || size < sizeof header) throw InputError(file, kNone);
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  if (header.magic != CheckpointHeader{}.magic) throw InputError(file, kNone);
  if (header.version != CheckpointHeader{}.version)
    throw damaged("is a checkpoint of another version");
  const uint64_t rest = size - sizeof header;
  if (header.runBytes > rest || header.stateBytes != rest - header.runBytes)
    throw damaged("is cut short or damaged");
  CheckpointFile found{std::string(header.runBytes, '\0'), std::string(header.stateBytes, '\0')};
  in.read(found.run.data(), static_cast<std::streamsize>(found.run.size()));
  in.read(found.state.data(), static_cast<std::streamsize>(found.state.size()));
  if (!in || header.checksum != checksumOf(header, found.run, found.state))
    throw damaged("is damaged (wrong checksum)");
  return found;
}

void writeCheckpoint(const fs::path& file, const CheckpointFile& checkpoint) {
  CheckpointHeader header;
  header.runBytes = checkpoint.run.size();
  header.stateBytes = checkpoint.state.size();
  header.checksum = checksumOf(header, checkpoint.run, checkpoint.state);
  AtomicFile out(file);
  out.write(bytesOf(header));
  out.write(checkpoint.run);
  out.write(checkpoint.state);
  out.commit();
}

}  // namespace bnvpl
