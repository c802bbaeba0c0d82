#include <stdexcept>

#include "formats/provenance.h"
#include "formats/vpl_io.h"
#include "formats/vpl_layout.h"

namespace bnvpl {
namespace {

// The whole file as consecutive pieces, padding included, so that it is never copied in memory.
std::vector<Bytes> filePieces(const VplHeader& header, const VplLayout& layout,
                              const std::string& provenance, const VplTable& table) {
  static constexpr std::array<std::byte, kVplAlign> kZeros{};
  std::vector<Bytes> pieces{bytesOf(header), std::as_bytes(std::span(layout.directory))};
  const auto addPadded = [&](Bytes bytes) {
    if (bytes.empty()) return;  // no rows: fwrite and the hash take no null pointer
    pieces.push_back(bytes);
    pieces.push_back(Bytes(kZeros).first(alignUp(bytes.size()) - bytes.size()));
  };
  addPadded(std::as_bytes(std::span(provenance)));
  forEachColumn(table, [&](const auto& column) { addPadded(std::as_bytes(std::span(column))); });
  pieces.push_back(bytesOf(kVplEndMark));
  return pieces;
}

void refuseUnwritable(const fs::path& file, const VplTable& table, const std::string& provenance) {
  size_t index = 0;
  forEachColumn(table, [&](const auto& column) {
    if (column.size() != table.size()) {
      throw std::logic_error(file.string() + ": column " + std::string(kVplColumns[index].name) +
                             " has " + std::to_string(column.size()) + " rows, position has " +
                             std::to_string(table.size()));
    }
    ++index;
  });
  const size_t ofLit = table.flux.size() + table.photons.size() + table.relativeError.size() +
                       table.emitPosition.size() + table.emitNormal.size() +
                       table.firstBounceFlux.size();
  const size_t surplus = (table.stage < VplStage::Eliminated ? table.radius.size() : 0) +
                         (table.stage < VplStage::Lit ? ofLit : 0);
  if (surplus > 0) {
    throw std::logic_error(file.string() + ": columns beyond stage " +
                           std::string(stageName(table.stage)) + " are filled");
  }
  if (const auto bad = findBadValue(table)) {
    throw std::logic_error(file.string() + ": column " +
                           std::string(kVplColumns[bad->column].name) + ", row " +
                           std::to_string(bad->row) + ": " + bad->problem +
                           "; not written, the old file, if any, is unchanged");
  }
  const auto require = [&](bool valid, const char* problem) {
    if (!valid) throw std::logic_error(file.string() + ": " + problem);
  };
  require(isMeasure(table.rMax), "r_max is negative or not finite");
  require(isMeasure(table.reach), "reach is negative or not finite");
  require(isMeasure(table.areaEstimate), "area is negative or not finite");
  require(isProvenance(provenance), "provenance is not a JSON array");
}

}  // namespace

void writeVpl(AtomicFile& file, const VplTable& table) {
  const std::string provenance = table.provenance.empty() ? "[]" : table.provenance;
  refuseUnwritable(file.target(), table, provenance);
  const VplLayout layout = makeLayout(table.stage, table.size(), provenance.size());
  VplHeader header;
  header.stage = table.stage;
  header.count = table.size();
  header.sceneHash = table.sceneHash;
  header.provenanceBytes = provenance.size();
  header.fileBytes = layout.fileBytes;
  header.columnCount = static_cast<uint32_t>(layout.directory.size());
  header.rMax = table.rMax;
  header.areaEstimate = table.areaEstimate;
  header.reach = table.reach;
  header.checksum = hashPieces(filePieces(header, layout, provenance, table));
  for (const Bytes piece : filePieces(header, layout, provenance, table)) file.write(piece);
}

void writeVpl(const fs::path& file, const VplTable& table) {
  AtomicFile out(file);
  writeVpl(out, table);
  out.commit();
}

}  // namespace bnvpl
