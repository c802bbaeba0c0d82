#include <stdexcept>

#include "core/hash.h"
#include "formats/provenance.h"
#include "formats/vpl/vpl_io.h"
#include "formats/vpl/vpl_layout.h"

namespace bnvpl {
namespace {

// The file as consecutive pieces with their padding, which avoids a copy in memory.
std::vector<Bytes> filePieces(const VplHeader& header, const VplLayout& layout,
                              const std::string& provenance, const VplTable& table) {
  static constexpr std::array<std::byte, kVplAlign> kZeros{};
  std::vector<Bytes> pieces{bytesOf(header), std::as_bytes(std::span(layout.directory))};
  const auto addPadded = [&](Bytes bytes) {
    if (bytes.empty()) return;  // without rows the pointer is null
    pieces.push_back(bytes);
    pieces.push_back(Bytes(kZeros).first(alignUp(bytes.size()) - bytes.size()));
  };
  addPadded(std::as_bytes(std::span(provenance)));
  for (const VplColumnView& column : columnsOf(table)) addPadded(column.bytes);
  pieces.push_back(bytesOf(kVplEndMark));
  return pieces;
}

// Describes a column of wrong length, or one that neither its stage nor a method can have; else
// empty.
std::string columnProblem(const VplTable& table) {
  if (table.emitPoints < 1 || table.emitPoints > kMaxEmitPoints) return "too many emission points";
  if (table.extras.size() > kMaxExtraColumns) return "too many columns of methods";
  for (size_t i = 0; i < table.extras.size(); ++i) {
    const auto bad = findBadField(table.extras[i], std::span(table.extras).first(i));
    if (bad) return bad->problem;
  }
  for (const VplColumnView& column : columnsOf(table)) {
    if (column.bytes.size() != table.size() * column.rowBytes()) {
      return "column " + std::string(column.name) + " has " + std::to_string(column.bytes.size()) +
             " bytes, expected " + std::to_string(table.size()) + " rows of " +
             std::to_string(column.rowBytes());
    }
  }
  for (const VplColumn& column :
       std::span(kVplColumns).subspan(standardColumns(table.stage).size())) {
    if (std::visit([&](auto member) { return !(table.*member).empty(); }, column.member)) {
      return "column " + std::string(column.name) + " is beyond stage " +
             std::string(stageName(table.stage));
    }
  }
  return "";
}

void refuseUnwritable(const fs::path& file, const VplTable& table, const std::string& provenance) {
  const auto require = [&](bool valid, const std::string& problem) {
    if (!valid) throw std::logic_error(file.string() + ": " + problem);
  };
  const std::string problem = columnProblem(table);
  require(problem.empty(), problem);
  if (const auto bad = findBadValue(table)) {
    require(false, "column " + std::string(columnsOf(table)[bad->column].name) + ", row " +
                       std::to_string(bad->row) + ": " + bad->problem +
                       "; not written, the old file, if any, is unchanged");
  }
  require(isMeasure(table.rMax), "r_max is negative or not finite");
  require(isMeasure(table.reachFactor), "reach is negative or not finite");
  require(isShare(table.indirectShare), "share of indirect light is not 0 to 1");
  require(isMeasure(table.areaEstimate), "area is negative or not finite");
  require(isProvenance(provenance), "provenance is not a JSON array");
}

}  // namespace

void writeVpl(AtomicFile& file, const VplTable& table) {
  const std::string provenance = table.provenance.empty() ? "[]" : table.provenance;
  refuseUnwritable(file.target(), table, provenance);
  const VplLayout layout = makeLayout(columnsOf(table), table.size(), provenance.size());
  VplHeader header;
  header.stage = table.stage;
  header.count = table.size();
  header.sceneHash = table.sceneHash;
  header.provenanceBytes = provenance.size();
  header.fileBytes = layout.fileBytes;
  header.columnCount = static_cast<uint32_t>(layout.directory.size());
  header.rMax = table.rMax;
  header.areaEstimate = table.areaEstimate;
  header.reach = table.reachFactor;
  header.indirectShare = table.indirectShare;
  header.checksum = hashPieces(filePieces(header, layout, provenance, table));
  for (const Bytes piece : filePieces(header, layout, provenance, table)) file.write(piece);
}

void writeVpl(const fs::path& file, const VplTable& table) {
  AtomicFile out(file);
  writeVpl(out, table);
  out.commit();
}

}  // namespace bnvpl
