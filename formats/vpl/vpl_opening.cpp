#include "formats/vpl/vpl_opening.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "formats/shard/checkpoint.h"
#include "formats/shard/shard_file.h"
#include "formats/vpl/vpl_io.h"

namespace bnvpl {
namespace {

constexpr const char* kRerun = "; copy it again or rerun the tool that made it";

void checkMagic(const InputFile& in, const VplHeader& header, uint64_t available) {
  const auto& magic = header.magic;
  const size_t length = std::min<uint64_t>(magic.size(), available);
  if (std::equal(magic.begin(), magic.begin() + length, kVplMagic.begin())) return;
  if (magic == ShardHeader{}.magic) {
    throw InputError(in.path(),
                     "is a shard, a part of a stage's work, and no .vpl file; merge all "
                     "shards with vpl-merge");
  }
  if (magic == CheckpointHeader{}.magic) {
    throw InputError(in.path(),
                     "is a checkpoint of a stopped run, and no .vpl file; the command of "
                     "that run goes on from it");
  }
  const bool looksLikeVpl = available >= 4 && std::memcmp(magic.data() + 1, "VPL", 3) == 0 &&
                            (magic[0] & 0x7f) == (kVplMagic[0] & 0x7f);
  if (looksLikeVpl) {
    throw FileError(in.path(), 0,
                    "magic damaged, as by a copy in text mode; copy it again in binary mode");
  }
  throw FileError(in.path(), 0, "not a .vpl file; check the name");
}

void checkVersion(const InputFile& in, uint32_t version) {
  if (version == kVplVersion) return;
  throw FileError(in.path(), offsetof(VplHeader, version),
                  "version " + std::to_string(version) + ", expected " +
                      std::to_string(kVplVersion) +
                      (version < kVplVersion ? "; rerun vpl-place and every later stage"
                                             : "; use the bnvpl that wrote it"));
}

void checkColumnCount(const InputFile& in, const VplHeader& header) {
  const size_t standard = standardColumns(header.stage).size();
  if (header.columnCount < standard || header.columnCount > standard + kMaxExtraColumns) {
    in.fail(offsetof(VplHeader, columnCount),
            std::to_string(header.columnCount) + " columns, a file of stage " +
                std::string(stageName(header.stage)) + " has " + std::to_string(standard) +
                ", and at most " + std::to_string(kMaxExtraColumns) + " of methods");
  }
  if (sizeof(VplHeader) + header.columnCount * sizeof(VplColumnEntry) > in.size()) {
    in.fail(offsetof(VplHeader, columnCount),
            std::to_string(header.columnCount) + " columns do not fit into the file");
  }
}

VplHeader readHeader(InputFile& in) {
  VplHeader header;
  const uint64_t available = std::min<uint64_t>(in.size(), sizeof(header));
  in.read(&header, available);
  checkMagic(in, header, available);
  if (available < sizeof(header)) in.fail(available, "cut short inside the header");
  checkVersion(in, header.version);
  if (header.stage < VplStage::Candidates || header.stage > VplStage::Lit) {
    in.fail(offsetof(VplHeader, stage),
            "unknown stage " + std::to_string(static_cast<uint32_t>(header.stage)));
  }
  if (in.size() < header.fileBytes) {
    in.fail(in.size(), "cut short: " + std::to_string(header.fileBytes) + " bytes were written");
  }
  if (in.size() > header.fileBytes) in.fail(header.fileBytes, "bytes after the end");
  checkColumnCount(in, header);
  if (header.rowKind != 0) {
    in.fail(offsetof(VplHeader, rowKind),
            "row kind " + std::to_string(header.rowKind) + ", this build knows 0, points");
  }
  if (header.reserved != std::array<char, sizeof(header.reserved)>{}) {
    in.fail(offsetof(VplHeader, reserved), "reserved field is not zero");
  }
  if (!isMeasure(header.rMax)) in.fail(offsetof(VplHeader, rMax), "r_max is not a length");
  if (!isMeasure(header.reach))
    in.fail(offsetof(VplHeader, reach), "reach is not zero or a positive number");
  if (!isMeasure(header.areaEstimate)) {
    in.fail(offsetof(VplHeader, areaEstimate), "area estimate is not an area");
  }
  if (!isShare(header.indirectShare)) {
    in.fail(offsetof(VplHeader, indirectShare), "share of indirect light is not 0 to 1");
  }
  return header;
}

uint64_t entryOffset(size_t column) { return sizeof(VplHeader) + column * sizeof(VplColumnEntry); }

template <size_t Size>
std::string textOf(const std::array<char, Size>& padded) {
  return {padded.begin(), std::find(padded.begin(), padded.end(), '\0')};
}

VplExtraColumn extraOf(const InputFile& in, const VplColumnEntry& entry, size_t column) {
  VplExtraColumn extra;
  extra.name = textOf(entry.name);
  extra.unit = textOf(entry.unit);
  extra.components = entry.components;
  switch (entry.type) {
    case VplType::F32:
      extra.values = std::vector<float>();
      break;
    case VplType::U32:
      extra.values = std::vector<uint32_t>();
      break;
    case VplType::U64:
      extra.values = std::vector<uint64_t>();
      break;
    default:
      in.fail(entryOffset(column) + offsetof(VplColumnEntry, type),
              "unknown type " + std::to_string(static_cast<uint32_t>(entry.type)));
  }
  return extra;
}

// Adds the extra columns of the directory to the table.
void addExtras(const InputFile& in, const std::vector<VplColumnEntry>& directory, VplTable& table) {
  for (size_t i = standardColumns(table.stage).size(); i < directory.size(); ++i) {
    VplExtraColumn extra = extraOf(in, directory[i], i);
    if (const auto bad = findBadField(extra, table.extras)) {
      in.fail(entryOffset(i) + bad->offset, bad->problem);
    }
    table.extras.push_back(std::move(extra));
  }
}

// Number of emission points per VPL, according to the directory.
uint32_t emitPointsOf(const std::vector<VplColumnEntry>& directory, VplStage stage) {
  const auto columns = standardColumns(stage);
  for (size_t i = 0; i < columns.size(); ++i) {
    const uint32_t elements = directory[i].components / columns[i].components();
    // checkDirectory() refuses an entry with any other number.
    if (columns[i].ofEmitPoints && elements >= 1 && elements <= kMaxEmitPoints) return elements;
  }
  return 1;
}

VplLayout checkShape(const InputFile& in, const VplHeader& header, const VplTable& shape) {
  const std::vector<VplColumnView> columns = columnsOf(shape);
  // A division cannot overflow for any claimed count.
  if (header.count > in.size() / rowBytes(columns)) {
    in.fail(offsetof(VplHeader, count),
            std::to_string(header.count) + " rows do not fit into the file");
  }
  if (header.provenanceBytes > in.size()) {
    in.fail(offsetof(VplHeader, provenanceBytes), "provenance does not fit into the file");
  }
  VplLayout layout = makeLayout(columns, header.count, header.provenanceBytes);
  if (layout.fileBytes != in.size()) {
    in.fail(offsetof(VplHeader, count), std::to_string(header.count) + " rows make a file of " +
                                            std::to_string(layout.fileBytes) + " bytes, not of " +
                                            std::to_string(in.size()));
  }
  return layout;
}

// Each entry must equal the one that the writer makes, so that no column overlaps another or is
// missing.
void checkDirectory(const InputFile& in, const std::vector<VplColumnEntry>& directory,
                    const VplLayout& layout, VplStage stage) {
  const size_t standard = standardColumns(stage).size();
  for (size_t i = 0; i < directory.size(); ++i) {
    const VplColumnEntry &entry = directory[i], &right = layout.directory[i];
    if (std::memcmp(&entry, &right, sizeof(entry)) == 0) continue;
    const std::string column = textOf(right.name);
    if (i < standard) in.fail(entryOffset(i), "directory entry is not that of column " + column);
    const auto require = [&](uint64_t is, uint64_t expected, size_t field, const char* what) {
      if (is == expected) return;
      in.fail(entryOffset(i) + field, std::string(what) + " of column " + column + " " +
                                          std::to_string(is) + ", expected " +
                                          std::to_string(expected));
    };
    require(entry.offset, right.offset, offsetof(VplColumnEntry, offset), "offset");
    require(entry.bytes, right.bytes, offsetof(VplColumnEntry, bytes), "bytes");
    in.fail(entryOffset(i), "name or unit of column " + column + " is not padded with zeros");
  }
}

}  // namespace

InputFile::InputFile(const fs::path& path) : path_(path) {
  // Non-blocking, so that a named pipe without a writer is refused below.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    throw InputError(path, std::string("cannot open: ") + std::strerror(errno) +
                               "; check the name, or run the stage that makes it");
  }
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0 || !S_ISREG(info.st_mode)) {
    ::close(descriptor_);
    throw InputError(path, "not a regular file; name a .vpl file");
  }
  size_ = static_cast<uint64_t>(info.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read(void* to, uint64_t bytes) {
  auto* next = static_cast<std::byte*>(to);
  while (bytes > 0) {
    const ssize_t got = ::read(descriptor_, next, std::min(bytes, uint64_t{1} << 30));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(position_, std::string("cannot read: ") + std::strerror(errno));
    if (got == 0) fail(position_, "the file shrank while it was read");
    next += got;
    bytes -= static_cast<uint64_t>(got);
    position_ += static_cast<uint64_t>(got);
  }
}

void InputFile::fail(uint64_t byte, const std::string& problem) const {
  throw FileError(path_, byte, problem + kRerun);
}

Opening readOpening(InputFile& in) {
  Opening opening;
  opening.header = readHeader(in);
  std::vector<VplColumnEntry> directory(opening.header.columnCount);
  in.read(directory.data(), directory.size() * sizeof(VplColumnEntry));
  opening.shape.stage = opening.header.stage;
  opening.shape.emitPoints = emitPointsOf(directory, opening.header.stage);
  addExtras(in, directory, opening.shape);
  opening.layout = checkShape(in, opening.header, opening.shape);
  checkDirectory(in, directory, opening.layout, opening.header.stage);
  return opening;
}

}  // namespace bnvpl
