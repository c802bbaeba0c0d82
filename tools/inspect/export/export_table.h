// Exports .vpl rows for other programs: `vpl-inspect export`.
#pragma once

#include "formats/atomic_file.h"
#include "formats/vpl/vpl_table.h"

namespace bnvpl {

// Writes all columns as PLY or CSV, by the extension of `output`, which the caller commits. Throws
// OutputError, and UsageError for any other extension; requireExportable() tests that in advance.
//
// CSV: a header line, then one line for each row, with 9 significant digits, which suffice to
// restore every float.
//
// PLY, binary little-endian: first n vertices, which are the rows in their order, with
//   x y z, nx ny nz     the first emission point of lit rows; position and normal of others
//   red green blue      8-bit sRGB of displayColours()
//   and all other columns under their CSV names; u64 as double.
// Then 2 n vertices that complete a small facet at each row, perpendicular to its normal, and n
// faces (row, n + 2 row, n + 2 row + 1). Importers that ignore normals and colours of points, such
// as Blender 3.4's, read both from these faces.
void exportTable(const VplTable& table, AtomicFile& output);
void requireExportable(const fs::path& output);

}  // namespace bnvpl
