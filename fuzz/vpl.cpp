// .vpl files: an accepted file is complete, has valid values, and is written back as the same
// bytes.
//
// The input is read as it is, and a second time with matching header, directory and checksum, which
// mutations would not find.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/hash.h"
#include "formats/provenance.h"
#include "formats/vpl/vpl_io.h"
#include "formats/vpl/vpl_layout.h"
#include "fuzz/fuzz.h"
#include "tools/common/run/run_tool.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {
namespace {

template <typename T>
void put(std::string& bytes, uint64_t at, const T& value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

// Extra columns of the repaired file, chosen by bytes of the input.
std::vector<VplExtraColumn> extrasOf(std::string_view input) {
  std::vector<VplExtraColumn> extras(static_cast<unsigned char>(input[60]) % 4);
  for (size_t i = 0; i < extras.size(); ++i) {
    extras[i].name = "fuzz.column" + std::to_string(i);
    const auto choice = static_cast<unsigned char>(input[61 + i]);
    extras[i].components = 1 + choice / 3 % 8;
    if (choice % 3 == 1) extras[i].values = std::vector<uint32_t>();
    if (choice % 3 == 2) extras[i].values = std::vector<uint64_t>();
  }
  return extras;
}

std::string repaired(std::string_view input) {
  if (input.size() < sizeof(VplHeader)) return {};
  VplHeader header;
  std::memcpy(&header, input.data(), sizeof(header));
  header.magic = kVplMagic;
  header.version = kVplVersion;
  header.stage = static_cast<VplStage>(1 + static_cast<uint32_t>(header.stage) % 3);
  header.rowKind = 0;
  VplTable shape;
  shape.stage = header.stage;
  shape.extras = extrasOf(input);
  const std::vector<VplColumnView> columns = columnsOf(shape);
  header.columnCount = static_cast<uint32_t>(columns.size());
  header.count %= input.size() / rowBytes(columns) + 2;
  header.provenanceBytes %= input.size();
  const VplLayout layout = makeLayout(columns, header.count, header.provenanceBytes);
  header.fileBytes = layout.fileBytes;
  header.checksum = 0;

  std::string file(input.substr(0, layout.fileBytes));
  file.resize(layout.fileBytes);
  put(file, 0, header);
  for (size_t i = 0; i < layout.directory.size(); ++i) {
    put(file, sizeof(header) + i * sizeof(VplColumnEntry), layout.directory[i]);
  }
  const auto zero = [&](uint64_t from, uint64_t to) {
    std::fill(file.data() + from, file.data() + to, '\0');
  };
  zero(layout.provenanceOffset + header.provenanceBytes, layout.directory.front().offset);
  for (const VplColumnEntry& column : layout.directory) {
    zero(column.offset + column.bytes, alignUp(column.offset + column.bytes));
  }
  put(file, layout.endMarkOffset, kVplEndMark);
  put(file, offsetof(VplHeader, checksum), hashPieces({std::as_bytes(std::span(file))}));
  return file;
}

void requireSane(const VplTable& t) {
  const std::vector<VplColumnView> columns = columnsOf(t);
  for (const VplColumnView& column : columns) {
    require(column.bytes.size() == t.size() * column.rowBytes(), "every column has all rows");
    for (size_t i = 0; i < t.size() * column.components; ++i)
      require(std::isfinite(column.value(0, i)), "values are finite");
  }
  require(columns.size() == standardColumns(t.stage).size() + t.extras.size(),
          "the columns of the stage and those of methods");
  for (const Vec3 n : t.normal) require(std::fabs(length(n) - 1.0f) < 0.01f, "normals are unit");
  for (const float r : t.radius) require(r > 0.0f, "radii are above 0");
  for (const float e : t.relativeError) require(e >= 0.0f, "errors are >= 0");
  for (const Vec3 f : t.flux) require(minComponent(f) >= 0.0f, "flux is >= 0");
  require(t.indirectShare >= 0.0 && t.indirectShare <= 1.0, "a share is 0 to 1");
  require(t.rMax >= 0.0 && t.areaEstimate >= 0.0 && t.reachFactor >= 0.0, "measures are >= 0");
}

// What is kept of a table is again one that can be written; two rows, the last one first.
void requireKeepable(const InputFolder& folder, const VplTable& table) {
  if (table.size() == 0) return;
  const std::vector<uint32_t> rows{static_cast<uint32_t>(table.size() - 1), 0};
  writeVpl(folder.at("kept.vpl"), keepRows(table, rows));
  require(readVpl(folder.at("kept.vpl")).position[1] == table.position[0], "rows are kept");
}

void read(const InputFolder& folder, const std::string& bytes) {
  const fs::path file = folder.write("in.vpl", bytes);
  VplTable table;
  if (!accepted([&] { table = readVpl(file); })) return;
  requireSane(table);
  const VplHeader header = readVplHeader(file);
  require(header.count == table.size(), "the header counts the rows");

  writeVpl(folder.at("out.vpl"), table);
  require(folder.read("out.vpl") == bytes, "reading and writing back gives the same bytes");
  requireKeepable(folder, table);

  makerOf(table.provenance);
  for (const StageRecord& record : parseProvenance(file, table.provenance)) describeRecord(record);
  extendProvenance(table.provenance, stageRecord("fuzz", Json::object(), Json::object()));
}

}  // namespace
}  // namespace bnvpl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bnvpl;
  static const InputFolder folder;
  const std::string input(reinterpret_cast<const char*>(data), size);
  read(folder, input);
  if (const std::string file = repaired(input); !file.empty()) read(folder, file);
  return 0;
}
