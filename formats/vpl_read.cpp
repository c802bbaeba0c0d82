#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>

#include "formats/provenance.h"
#include "formats/vpl_io.h"
#include "formats/vpl_layout.h"

namespace bnvpl {
namespace {

constexpr const char* kRerun = "; copy it again or rerun the tool that made it";

class InputFile {
 public:
  explicit InputFile(const fs::path& path) : path_(path) {
    // Not blocking: a named pipe without a writer is refused below instead of waited for.
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
  ~InputFile() { ::close(descriptor_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const fs::path& path() const { return path_; }
  uint64_t size() const { return size_; }

  // The next `bytes` bytes of the file.
  void read(void* to, uint64_t bytes) {
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
  [[noreturn]] void fail(uint64_t byte, const std::string& problem) const {
    throw FileError(path_, byte, problem + kRerun);
  }

 private:
  fs::path path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  uint64_t position_ = 0;
};

void checkMagic(const InputFile& in, const VplHeader& header, uint64_t available) {
  const auto& magic = header.magic;
  const size_t length = std::min<uint64_t>(magic.size(), available);
  if (std::equal(magic.begin(), magic.begin() + length, kVplMagic.begin())) return;
  const bool looksLikeVpl = available >= 4 && std::memcmp(magic.data() + 1, "VPL", 3) == 0 &&
                            (magic[0] & 0x7f) == (kVplMagic[0] & 0x7f);
  if (looksLikeVpl) {
    throw FileError(in.path(), 0,
                    "magic damaged, as by a copy in text mode; copy it again in binary mode");
  }
  throw FileError(in.path(), 0, "not a .vpl file; check the name");
}

// Everything the header says, against the constants and the real size of the file.
VplHeader readHeader(InputFile& in) {
  VplHeader header;
  const uint64_t available = std::min<uint64_t>(in.size(), sizeof(header));
  in.read(&header, available);
  checkMagic(in, header, available);
  if (available < sizeof(header)) in.fail(available, "cut short inside the header");
  if (header.version < 1 || header.version > kVplVersion) {
    throw FileError(in.path(), offsetof(VplHeader, version),
                    "version " + std::to_string(header.version) + ", this build reads up to " +
                        std::to_string(kVplVersion) + "; use the bnvpl that wrote it");
  }
  if (header.version < kLitSince && header.stage == VplStage::Lit) {
    throw FileError(in.path(), offsetof(VplHeader, version),
                    "version " + std::to_string(header.version) +
                        " of lit VPLs does not tell straight light apart; rerun vpl-estimate");
  }
  if (header.stage < VplStage::Candidates || header.stage > VplStage::Lit) {
    in.fail(offsetof(VplHeader, stage),
            "unknown stage " + std::to_string(static_cast<uint32_t>(header.stage)));
  }
  if (header.columnCount != columnCount(header.stage)) {
    in.fail(offsetof(VplHeader, columnCount), std::to_string(header.columnCount) +
                                                  " columns, a file of stage " +
                                                  std::string(stageName(header.stage)) + " has " +
                                                  std::to_string(columnCount(header.stage)));
  }
  if (in.size() < header.fileBytes) {
    in.fail(in.size(), "cut short: " + std::to_string(header.fileBytes) + " bytes were written");
  }
  if (in.size() > header.fileBytes) in.fail(header.fileBytes, "bytes after the end");
  return header;
}

VplLayout checkShape(const InputFile& in, const VplHeader& header) {
  // Divided, not multiplied, so that no claimed count can overflow.
  if (header.count > in.size() / rowBytes(header.stage)) {
    in.fail(offsetof(VplHeader, count),
            std::to_string(header.count) + " rows do not fit into the file");
  }
  if (header.provenanceBytes > in.size()) {
    in.fail(offsetof(VplHeader, provenanceBytes), "provenance does not fit into the file");
  }
  VplLayout layout = makeLayout(header.stage, header.count, header.provenanceBytes);
  if (layout.fileBytes != in.size()) {
    in.fail(offsetof(VplHeader, count), std::to_string(header.count) + " rows make a file of " +
                                            std::to_string(layout.fileBytes) + " bytes, not of " +
                                            std::to_string(in.size()));
  }
  if (header.reserved0 != 0) in.fail(offsetof(VplHeader, reserved0), "reserved field is not zero");
  if (header.reserved != std::array<char, sizeof(header.reserved)>{}) {
    in.fail(offsetof(VplHeader, reserved), "reserved field is not zero");
  }
  if (!isMeasure(header.rMax)) in.fail(offsetof(VplHeader, rMax), "r_max is not a length");
  if (!isMeasure(header.reach)) in.fail(offsetof(VplHeader, reach), "reach is not a length");
  if (!isMeasure(header.areaEstimate)) {
    in.fail(offsetof(VplHeader, areaEstimate), "area estimate is not an area");
  }
  return layout;
}

void readDirectory(InputFile& in, const VplLayout& layout) {
  for (size_t i = 0; i < layout.directory.size(); ++i) {
    VplColumnEntry entry;
    in.read(&entry, sizeof(entry));
    if (std::memcmp(&entry, &layout.directory[i], sizeof(entry)) != 0) {
      in.fail(sizeof(VplHeader) + i * sizeof(entry),
              "directory entry is not that of column " + std::string(kVplColumns[i].name));
    }
  }
}

// The verified start of the file: what can be known without reading the content.
struct Opening {
  VplHeader header;
  VplLayout layout;
};
Opening readOpening(InputFile& in) {
  const VplHeader header = readHeader(in);
  VplLayout layout = checkShape(in, header);
  readDirectory(in, layout);
  return {header, std::move(layout)};
}

void checkPadding(const InputFile& in, Bytes content, uint64_t from, uint64_t to) {
  for (uint64_t i = from; i < to; ++i) {
    if (content[i] != std::byte{0}) in.fail(i, "padding is not zero");
  }
}

// End mark, checksum and padding of the whole file.
void checkContent(const InputFile& in, Bytes file, const VplHeader& header,
                  const VplLayout& layout) {
  if (std::memcmp(file.data() + layout.endMarkOffset, kVplEndMark.data(), kVplEndMark.size()) !=
      0) {
    in.fail(layout.endMarkOffset, "no end mark");
  }
  VplHeader hashed = header;
  hashed.checksum = 0;
  if (hashPieces({bytesOf(hashed), file.subspan(sizeof(VplHeader))}) != header.checksum) {
    in.fail(offsetof(VplHeader, checksum), "checksum does not match: the content is damaged");
  }
  checkPadding(in, file, layout.provenanceOffset + header.provenanceBytes,
               layout.directory.front().offset);
  for (size_t i = 0; i < layout.directory.size(); ++i) {
    const VplColumnEntry& entry = layout.directory[i];
    const bool last = i + 1 == layout.directory.size();
    checkPadding(in, file, entry.offset + entry.bytes,
                 last ? layout.endMarkOffset : layout.directory[i + 1].offset);
  }
}

VplTable makeTable(const InputFile& in, Bytes file, const VplHeader& header,
                   const VplLayout& layout) {
  VplTable table;
  table.stage = header.stage;
  table.rMax = header.rMax;
  table.areaEstimate = header.areaEstimate;
  table.reach = header.reach;
  table.sceneHash = header.sceneHash;
  table.checksum = header.checksum;
  table.provenance.assign(reinterpret_cast<const char*>(file.data()) + layout.provenanceOffset,
                          header.provenanceBytes);
  if (!isProvenance(table.provenance)) {
    in.fail(layout.provenanceOffset,
            "provenance is not a JSON array of objects, or is nested too deeply");
  }
  auto entry = layout.directory.begin();
  forEachColumn(table, [&](auto& column) {
    column.resize(header.count);
    if (entry->bytes > 0) {
      std::memcpy(static_cast<void*>(column.data()), file.data() + entry->offset, entry->bytes);
    }
    ++entry;
  });
  if (const auto bad = findBadValue(table)) {
    in.fail(layout.directory[bad->column].offset + bad->row * kVplColumns[bad->column].rowBytes(),
            "column " + std::string(kVplColumns[bad->column].name) + ", row " +
                std::to_string(bad->row) + ": " + bad->problem);
  }
  return table;
}

VplTable readTable(const fs::path& path, std::optional<VplStage> expected) {
  InputFile in(path);
  const auto [header, layout] = readOpening(in);
  if (expected && header.stage != *expected) {
    throw InputError(path, "is of stage " + std::string(stageName(header.stage)) + " (by " +
                               std::string(stageTool(header.stage)) + "), stage " +
                               std::string(stageName(*expected)) + " is needed; make it with " +
                               std::string(stageTool(*expected)));
  }
  const auto buffer = std::make_unique_for_overwrite<std::byte[]>(in.size());
  const uint64_t opening = layout.provenanceOffset;
  std::memcpy(buffer.get(), &header, sizeof(header));
  std::memcpy(buffer.get() + sizeof(header), layout.directory.data(), opening - sizeof(header));
  in.read(buffer.get() + opening, in.size() - opening);
  const Bytes file(buffer.get(), in.size());
  checkContent(in, file, header, layout);
  return makeTable(in, file, header, layout);
}

}  // namespace

VplHeader readVplHeader(const fs::path& file) {
  InputFile in(file);
  return readOpening(in).header;
}

VplTable readVpl(const fs::path& file) { return readTable(file, std::nullopt); }

VplTable readVpl(const fs::path& file, VplStage expected) { return readTable(file, expected); }

}  // namespace bnvpl
