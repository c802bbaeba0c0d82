// .vpl rows for other programs: `vpl-inspect export`.
#pragma once

#include <string>

#include "formats/atomic_file.h"
#include "formats/vpl_format.h"
#include "formats/vpl_table.h"

namespace bnvpl {

// Binary little-endian PLY point cloud: x y z nx ny nz, red green blue (8-bit sRGB), id, and as
// floats radius, flux_r flux_g flux_b, photons, relative_error, straight_flux_r straight_flux_g
// straight_flux_b where the stage has them.
std::string plyBytes(const VplTable& table);

// A header line, then one line for each row; 9 significant digits give every float back.
std::string csvText(const VplTable& table);

// Writes PLY or CSV, by the extension of `output`, which is left for the caller to commit. Throws
// UsageError on any other extension (call requireExportable first to find that out before reading)
// and OutputError.
void exportTable(const VplTable& table, AtomicFile& output);
void requireExportable(const fs::path& output);

}  // namespace bnvpl
