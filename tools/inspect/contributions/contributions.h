// The light that each VPL contributes to each pixel of the film: `vpl-inspect contributions`.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "formats/vpl/vpl_table.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// Columns of a film in the scene's shape unless --size asks for another.
inline constexpr uint32_t kContributionColumns = 80;

struct ContributionOptions {
  Film film;                    // resolution of the table
  unsigned samplesPerAxis = 2;  // camera rays per pixel and axis
  size_t perPixel = 64;         // VPLs that are listed for a pixel
  float clamp = 2.0f;           // that of vpl-render, in units of the VPL's radius
};

// VPL light of one pixel: the mean of the channels, W/(m2 sr).
struct PixelContributions {
  float radiance = 0.0f;       // all VPLs' light
  std::vector<uint32_t> rows;  // numbers in the table, strongest first; equal ones ascending
  std::vector<float> shares;   // in `radiance`, 0..1
};

struct Contributions {
  Film film;
  std::vector<PixelContributions> pixels;  // row by row from the top
  std::vector<double> radiance;  // mean over the film for each row of the table, W/(m2 sr)
};

// Sums, at each surface that a camera ray meets first or behind specular ones, the light of every
// VPL without what compensation adds, as `vpl-render --gather all --compensate none` does. Counts
// rows of the film as progress.
Contributions contributionsOf(const Accelerator& accel, const VplTable& lit,
                              const ContributionOptions& options, const ProgressFn& progress);

// Memory in bytes that the contributions of `rows` VPLs and their JSON take.
double memoryOfContributions(const ContributionOptions& options, size_t rows);

// The film of the table's default size.
Film contributionFilm(const Film& scene);

}  // namespace bnvpl
