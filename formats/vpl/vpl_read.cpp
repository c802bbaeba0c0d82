#include <cstring>
#include <memory>
#include <optional>

#include "core/hash.h"
#include "formats/provenance.h"
#include "formats/vpl/vpl_io.h"
#include "formats/vpl/vpl_opening.h"

namespace bnvpl {
namespace {

void checkPadding(const InputFile& in, Bytes content, uint64_t from, uint64_t to) {
  for (uint64_t i = from; i < to; ++i) {
    if (content[i] != std::byte{0}) in.fail(i, "padding is not zero");
  }
}

// Checks end mark, checksum and padding of the whole file.
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

// The table of an opening, with the values of `file`.
VplTable makeTable(const InputFile& in, Bytes file, Opening opening) {
  const VplHeader& header = opening.header;
  const VplLayout& layout = opening.layout;
  VplTable table = std::move(opening.shape);
  table.rMax = header.rMax;
  table.areaEstimate = header.areaEstimate;
  table.reachFactor = header.reach;
  table.indirectShare = header.indirectShare;
  table.sceneHash = header.sceneHash;
  table.checksum = header.checksum;
  table.provenance.assign(reinterpret_cast<const char*>(file.data()) + layout.provenanceOffset,
                          header.provenanceBytes);
  if (!isProvenance(table.provenance)) {
    in.fail(layout.provenanceOffset,
            "provenance is not a JSON array of objects, or is nested too deeply");
  }
  auto entry = layout.directory.begin();
  forEachColumn(table, [&](auto& values, size_t perRow) {
    values.resize(header.count * perRow);
    if (entry->bytes > 0) {
      std::memcpy(static_cast<void*>(values.data()), file.data() + entry->offset, entry->bytes);
    }
    ++entry;
  });
  if (const auto bad = findBadValue(table)) {
    const VplColumnView column = columnsOf(table)[bad->column];
    in.fail(layout.directory[bad->column].offset + bad->row * column.rowBytes(),
            "column " + std::string(column.name) + ", row " + std::to_string(bad->row) + ": " +
                bad->problem);
  }
  return table;
}

[[noreturn]] void failStage(InputFile& in, const VplHeader& header, VplStage expected,
                            std::string_view makers) {
  std::string provenance(header.provenanceBytes, '\0');
  in.read(provenance.data(), provenance.size());
  const std::string maker = makerOf(provenance);
  // Lit VPLs can also come from vpl-place: then no stage was forgotten.
  const bool done = header.stage == VplStage::Lit && expected == VplStage::Eliminated;
  throw InputError(
      in.path(),
      "is of stage " + std::string(stageName(header.stage)) +
          (maker.empty() ? "" : " (by " + maker + ")") +
          (done ? ": its VPLs have their flux; pass it to vpl-render"
                : ", stage " + std::string(stageName(expected)) + " is needed; make it with " +
                      std::string(makers.empty() ? stageTools(expected) : makers)));
}

VplTable readTable(const fs::path& path, std::optional<VplStage> expected,
                   std::string_view makers = {}) {
  InputFile in(path);
  Opening opening = readOpening(in);
  const VplHeader& header = opening.header;
  if (expected && header.stage != *expected) failStage(in, header, *expected, makers);
  const auto buffer = std::make_unique_for_overwrite<std::byte[]>(in.size());
  const uint64_t read = opening.layout.provenanceOffset;
  std::memcpy(buffer.get(), &header, sizeof(header));
  std::memcpy(buffer.get() + sizeof(header), opening.layout.directory.data(),
              read - sizeof(header));
  in.read(buffer.get() + read, in.size() - read);
  const Bytes file(buffer.get(), in.size());
  checkContent(in, file, header, opening.layout);
  return makeTable(in, file, std::move(opening));
}

}  // namespace

VplHeader readVplHeader(const fs::path& file) {
  InputFile in(file);
  return readOpening(in).header;
}

VplTable readVpl(const fs::path& file) { return readTable(file, std::nullopt); }

VplTable readVpl(const fs::path& file, VplStage expected, std::string_view makers) {
  return readTable(file, expected, makers);
}

std::string_view stageName(VplStage stage) {
  switch (stage) {
    case VplStage::Candidates:
      return "candidates";
    case VplStage::Eliminated:
      return "eliminated";
    case VplStage::Lit:
      return "lit";
  }
  return "unknown";
}

std::string_view stageTools(VplStage stage) {
  switch (stage) {
    case VplStage::Candidates:
      return "vpl-place";
    case VplStage::Eliminated:
      return "vpl-eliminate";
    case VplStage::Lit:
      return "vpl-estimate or a vpl-place --method that lights VPLs";
  }
  return "unknown";
}

}  // namespace bnvpl
