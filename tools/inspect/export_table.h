// .vpl rows for other programs: `vpl-inspect export`.
#pragma once

#include "formats/atomic_file.h"
#include "formats/vpl_table.h"

namespace bnvpl {

// Writes PLY or CSV, by the extension of `output`, which is left for the caller to commit. Throws
// UsageError on any other extension (call requireExportable first to find that out before reading)
// and OutputError. Both have all columns.
//
// CSV: a header line, then one line for each row; 9 significant digits give every float back.
//
// PLY, binary little-endian: first n vertices, which are the rows in their order, with
//   x y z, nx ny nz     where the light leaves from; of rows without flux, position and normal
//   red green blue      8-bit sRGB of displayColours()
//   and all other columns under their CSV names; u64 as double.
// Then 2 n vertices that close a small facet at each row's place, perpendicular to its normal, and
// n faces (row, n + 2 row, n + 2 row + 1): importers that take neither normals nor colours from
// points, such as Blender 3.4's, take both from these.
void exportTable(const VplTable& table, AtomicFile& output);
void requireExportable(const fs::path& output);

}  // namespace bnvpl
