#include "tools/inspect/export/export_table.h"

#include <cstdio>
#include <cstring>

#include "core/files.h"
#include "formats/image/tonemap.h"
#include "formats/vpl/vpl_io.h"
#include "tools/common/stage/output_kind.h"
#include "tools/inspect/column_names.h"
#include "tools/inspect/display_colour.h"
#include "tools/inspect/facets.h"

namespace bnvpl {
namespace {

constexpr size_t kBytesAtOnce = size_t{1} << 20;

template <typename T>
void appendValue(std::string& bytes, T value) {  // little-endian, as vpl_format.h asserts
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void appendVec(std::string& bytes, Vec3 v) {
  appendValue(bytes, v.x);
  appendValue(bytes, v.y);
  appendValue(bytes, v.z);
}

std::vector<Vec3> firstPoints(const VplTable& table, const std::vector<Vec3>& points) {
  std::vector<Vec3> first;
  for (size_t row = 0; row < table.size(); ++row) first.push_back(points[row * table.emitPoints]);
  return first;
}

// Properties of the vertices: those that PLY names, then all other columns.
struct Vertices {
  explicit Vertices(const VplTable& table)
      : lit(table.stage == VplStage::Lit),
        places(lit ? firstPoints(table, table.emitPosition) : table.position),
        normals(lit ? firstPoints(table, table.emitNormal) : table.normal),
        colours(displayColours(table)) {
    const char* place = lit ? "emit_position" : "position";
    const char* normal = lit ? "emit_normal" : "normal";
    for (const VplColumnView& column : columnsOf(table)) {
      // A row with several emission points is drawn at the first and lists all as properties.
      if ((column.name != place && column.name != normal) || column.components > 3)
        others.push_back(column);
    }
  }
  bool lit;
  std::vector<Vec3> places, normals, colours;
  std::vector<VplColumnView> others;
};

const char* plyType(VplType type) {
  return type == VplType::F32 ? "float" : type == VplType::U32 ? "uint" : "double";
}

std::string plyHeader(const VplTable& table, const Vertices& vertices) {
  const std::string rows = std::to_string(table.size());
  std::string header = "ply\nformat binary_little_endian 1.0\n" + std::string(kPlyMark) +
                       std::string(stageName(table.stage)) + " rows, lengths in scene units\n";
  if (vertices.lit) {
    char full[32];
    std::snprintf(full, sizeof full, "%.6g", double{displayFlux(table)});
    header +=
        "comment x y z is emit_position, nx ny nz emit_normal, red green blue the flux over its "
        "99th percentile, " +
        std::string(full) + " W, in sRGB\n";
  } else {
    header += "comment x y z is position, nx ny nz normal, red green blue the albedo, in sRGB\n";
  }
  header += "comment the first " + rows + " vertices are the rows, the others close their facets\n";
  header += "element vertex " + std::to_string(3 * table.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    header += std::string("property float ") + name + "\n";
  }
  for (const char* name : {"red", "green", "blue"}) {
    header += std::string("property uchar ") + name + "\n";
  }
  for (const VplColumnView& column : vertices.others) {
    for (size_t k = 0; k < column.components; ++k) {
      header += std::string("property ") + plyType(column.type) + " " +
                componentName(column, k, '_') + "\n";
    }
  }
  return header + "element face " + rows + "\nproperty list uchar int vertex_indices\nend_header\n";
}

void appendVertex(std::string& bytes, const Vertices& vertices, size_t row, Vec3 place) {
  appendVec(bytes, place);
  appendVec(bytes, vertices.normals[row]);
  for (size_t k = 0; k < 3; ++k) appendValue(bytes, toSrgb8(vertices.colours[row][k]));
  for (const VplColumnView& column : vertices.others) {
    if (column.type == VplType::U64) {  // PLY lacks this type: written as double
      for (size_t k = 0; k < column.components; ++k) appendValue(bytes, column.value(row, k));
    } else {
      const auto values = column.row(row);
      bytes.append(reinterpret_cast<const char*>(values.data()), values.size());
    }
  }
}

void writePly(const VplTable& table, AtomicFile& output) {
  const Vertices vertices(table);
  const std::vector<float> legs = facetLegs(table, vertices.places);
  std::string bytes = plyHeader(table, vertices);
  const auto each = [&](const auto& append) {
    for (size_t row = 0; row < table.size(); ++row) {
      append(row);
      if (bytes.size() < kBytesAtOnce) continue;
      output.write(bytes);
      bytes.clear();
    }
  };
  each([&](size_t row) { appendVertex(bytes, vertices, row, vertices.places[row]); });
  each([&](size_t row) {
    for (const Vec3 corner : facetCorners(vertices.places[row], vertices.normals[row], legs[row]))
      appendVertex(bytes, vertices, row, corner);
  });
  each([&](size_t row) {
    const size_t corner = table.size() + 2 * row;
    appendValue(bytes, uint8_t{3});
    for (const size_t vertex : {row, corner, corner + 1})
      appendValue(bytes, static_cast<int32_t>(vertex));
  });
  output.write(bytes);
}

void appendCell(std::string& text, const VplColumnView& column, size_t row, size_t component) {
  char value[32];
  if (column.type == VplType::F32) {
    std::snprintf(value, sizeof value, "%.9g", column.value(row, component));
  } else {
    uint64_t whole = 0;  // little-endian: a u32 fills the lower half
    const size_t size = sizeOf(column.type);
    std::memcpy(&whole, column.row(row).data() + component * size, size);
    std::snprintf(value, sizeof value, "%llu", static_cast<unsigned long long>(whole));
  }
  text += value;
}

void writeCsv(const VplTable& table, AtomicFile& output) {
  const std::vector<VplColumnView> columns = columnsOf(table);
  std::string text;
  const auto eachCell = [&](const auto& append) {
    bool first = true;
    for (const VplColumnView& column : columns) {
      for (size_t k = 0; k < column.components; ++k) {
        if (!first) text += ',';
        append(column, k);
        first = false;
      }
    }
    text += '\n';
  };
  eachCell([&](const VplColumnView& column, size_t k) { text += componentName(column, k, '_'); });
  for (size_t row = 0; row < table.size(); ++row) {
    eachCell([&](const VplColumnView& column, size_t k) { appendCell(text, column, row, k); });
    if (text.size() < kBytesAtOnce) continue;
    output.write(text);
    text.clear();
  }
  output.write(text);
}

}  // namespace

void requireExportable(const fs::path& output) {
  const std::string extension = lowerExtension(output);
  if (extension == ".ply" || extension == ".csv") return;
  throw UsageError("--output " + output.string() + ": the extension must be .ply or .csv");
}

void exportTable(const VplTable& table, AtomicFile& output) {
  requireExportable(output.target());
  if (lowerExtension(output.target()) == ".ply")
    writePly(table, output);
  else
    writeCsv(table, output);
}

}  // namespace bnvpl
