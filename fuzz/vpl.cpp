// .vpl files: what readVpl accepts is whole, has sane values, and writes back as the same bytes.
//
// The input is read as it is, and a second time with header, directory and checksum made to fit:
// no mutation would pass the checksum.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "formats/vpl_io.h"
#include "formats/vpl_layout.h"
#include "fuzz/fuzz.h"
#include "tools/common/run_tool.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {
namespace {

template <typename T>
void put(std::string& bytes, uint64_t at, const T& value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

std::string repaired(std::string_view input) {
  if (input.size() < sizeof(VplHeader)) return {};
  VplHeader header;
  std::memcpy(&header, input.data(), sizeof(header));
  header.magic = kVplMagic;
  header.version = kVplVersion;
  header.stage = static_cast<VplStage>(1 + static_cast<uint32_t>(header.stage) % 3);
  header.columnCount = static_cast<uint32_t>(columnCount(header.stage));
  header.count %= input.size() / rowBytes(header.stage) + 2;
  header.provenanceBytes %= input.size();
  const VplLayout layout = makeLayout(header.stage, header.count, header.provenanceBytes);
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
  const auto finite = [](const auto& column) {
    return std::all_of(column.begin(), column.end(), isFinite);
  };
  require(finite(t.position) && finite(t.normal) && finite(t.albedo) && finite(t.flux) &&
              finite(t.emitPosition) && finite(t.emitNormal) && finite(t.firstBounceFlux),
          "vectors are finite");
  for (const Vec3 n : t.normal) require(std::fabs(length(n) - 1.0f) < 0.01f, "normals are unit");
  for (const float r : t.radius) require(std::isfinite(r) && r > 0.0f, "radii are above 0");
  for (const float e : t.relativeError) require(std::isfinite(e) && e >= 0.0f, "errors are >= 0");
  for (const Vec3 f : t.flux) require(std::min({f.x, f.y, f.z}) >= 0.0f, "flux is >= 0");
  require(t.rMax >= 0.0 && t.areaEstimate >= 0.0 && t.reach >= 0.0, "measures are >= 0");
  const size_t n = t.size(), e = t.stage >= VplStage::Eliminated ? n : 0,
               l = t.stage >= VplStage::Lit ? n : 0;
  require(t.normal.size() == n && t.albedo.size() == n && t.id.size() == n &&
              t.radius.size() == e && t.flux.size() == l && t.photons.size() == l &&
              t.relativeError.size() == l && t.emitPosition.size() == l &&
              t.emitNormal.size() == l && t.firstBounceFlux.size() == l,
          "every column of the stage has all rows");
}

void read(const InputFolder& folder, const std::string& bytes) {
  const fs::path file = folder.write("in.vpl", bytes);
  VplTable table;
  if (!accepted([&] { table = readVpl(file); })) return;
  requireSane(table);
  const VplHeader header = readVplHeader(file);
  require(header.count == table.size(), "the header counts the rows");

  writeVpl(folder.at("out.vpl"), table);
  if (header.version == kVplVersion) {
    require(folder.read("out.vpl") == bytes, "reading and writing back gives the same bytes");
  } else {
    require(readVpl(folder.at("out.vpl")).position == table.position,
            "an older version has the same rows in the newest");
  }

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
