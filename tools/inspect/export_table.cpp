#include "tools/inspect/export_table.h"

#include <cmath>
#include <cstdio>

#include "formats/tonemap.h"
#include "formats/vpl_io.h"
#include "tools/inspect/column_names.h"
#include "tools/inspect/display_colour.h"

namespace bnvpl {
namespace {

template <typename T>
void appendValue(std::string& bytes, T value) {  // little-endian, as vpl_format.h asserts
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendVec(std::string& bytes, Vec3 v) {
  appendValue(bytes, v.x);
  appendValue(bytes, v.y);
  appendValue(bytes, v.z);
}

std::string plyHeader(const VplTable& table) {
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment vpl-inspect, " +
                       std::string(stageName(table.stage)) +
                       " rows, lengths in scene units\nelement vertex " +
                       std::to_string(table.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    header += std::string("property float ") + name + "\n";
  }
  for (const char* name : {"red", "green", "blue"}) {
    header += std::string("property uchar ") + name + "\n";
  }
  header += "property uint id\n";
  if (table.stage >= VplStage::Eliminated) header += "property float radius\n";
  if (table.stage >= VplStage::Lit) {
    for (const char* name : {"flux_r", "flux_g", "flux_b", "photons", "relative_error",
                             "straight_flux_r", "straight_flux_g", "straight_flux_b"}) {
      header += std::string("property float ") + name + "\n";
    }
  }
  return header + "end_header\n";
}

}  // namespace

std::string plyBytes(const VplTable& table) {
  std::string bytes = plyHeader(table);
  const std::vector<Vec3> colours = displayColours(table);
  for (size_t i = 0; i < table.size(); ++i) {
    appendVec(bytes, table.position[i]);
    appendVec(bytes, table.normal[i]);
    for (size_t k = 0; k < 3; ++k) appendValue(bytes, toSrgb8(colours[i][k]));
    appendValue(bytes, table.id[i]);
    if (table.stage >= VplStage::Eliminated) appendValue(bytes, table.radius[i]);
    if (table.stage >= VplStage::Lit) {
      appendVec(bytes, table.flux[i]);
      appendValue(bytes, static_cast<float>(table.photons[i]));
      appendValue(bytes, table.relativeError[i]);
      appendVec(bytes, table.firstBounceFlux[i]);
    }
  }
  return bytes;
}

std::string csvText(const VplTable& table) {
  const auto infos = columnInfo(table.stage);
  std::string text;
  for (const VplColumnInfo& info : infos) {
    for (size_t k = 0; k < info.components; ++k) {
      text += (text.empty() ? "" : ",") + componentName(info, k, '_');
    }
  }
  text += '\n';
  for (size_t row = 0; row < table.size(); ++row) {
    bool first = true;
    for (size_t c = 0; c < infos.size(); ++c) {
      for (size_t k = 0; k < infos[c].components; ++k) {
        char value[32];
        std::snprintf(value, sizeof value, infos[c].type == VplType::F32 ? "%.9g" : "%.0f",
                      columnValue(table, c, row, k));
        if (!first) text += ',';
        text += value;
        first = false;
      }
    }
    text += '\n';
  }
  return text;
}

void requireExportable(const fs::path& output) {
  const fs::path extension = output.extension();
  if (extension == ".ply" || extension == ".csv") return;
  throw UsageError("--output " + output.string() + ": the extension must be .ply or .csv");
}

void exportTable(const VplTable& table, AtomicFile& output) {
  requireExportable(output.target());
  output.write(output.target().extension() == ".ply" ? plyBytes(table) : csvText(table));
}

}  // namespace bnvpl
