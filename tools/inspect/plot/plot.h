// Draws the rows of a .vpl file as dots over the camera's view of the scene, as in figure 3.2 of
// the thesis: `vpl-inspect plot`.
#pragma once

#include "formats/vpl/vpl_table.h"
#include "tools/inspect/plot/plot_canvas.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

enum class DotColour { Flux, Contribution, Radius, Plain };

struct PlotOptions {
  double dotPixels = 5.0;  // diameter
  DotColour colour = DotColour::Plain;
  bool showBack = false;  // draw rings for visible rows whose lit side faces away
  unsigned samples = 3;   // samples of the view per pixel and axis
  // Contribution of each row to the film, for DotColour::Contribution.
  std::vector<double> contributions = {};
};

// Numbers of rows by visibility; they add up to all rows.
struct PlotCounts {
  size_t drawn = 0;       // visible, lit side towards the camera
  size_t facingAway = 0;  // lit side away from the camera, on the film or not
  size_t occluded = 0;
  size_t outside = 0;  // projected outside the film
};

// Renders the scene from its camera with a headlight, dimmed and without dots. Specular surfaces
// show what they reflect or transmit.
Canvas shadeView(const Accelerator& accel, unsigned samplesPerAxis);

// Throws InputError, which names the file of the rows, if they lack the column of the colour.
void requireColours(const fs::path& file, const VplTable& table, DotColour colour);

// The visible dots, in row order. The rows must have the column of the colour.
std::vector<Dot> visibleDots(const VplTable& table, const Accelerator& accel,
                             const PlotOptions& options, PlotCounts& counts);

}  // namespace bnvpl
