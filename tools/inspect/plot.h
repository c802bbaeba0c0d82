// The rows of a .vpl file as dots over the camera's view of the scene: `vpl-inspect plot`, as in
// figure 3.2 of the thesis.
#pragma once

#include "formats/vpl_table.h"
#include "tools/inspect/plot_canvas.h"
#include "transport/rays.h"

namespace bnvpl {

enum class DotColour { Flux, Radius, Plain };

struct PlotOptions {
  double dotPixels = 5.0;  // diameter
  DotColour colour = DotColour::Plain;
  bool showBack = false;  // rings for rows in sight whose lit side faces away
  unsigned samples = 3;   // per pixel and axis, of the view
};

// Where the rows went; they add up to all rows.
struct PlotCounts {
  size_t drawn = 0;       // in sight, lit side towards the camera
  size_t facingAway = 0;  // lit side away from the camera, wherever they are on the film
  size_t occluded = 0;
  size_t outside = 0;  // of the film
};

// The scene from its camera with a headlight, somewhat dimmed and without dots. Mirrors and glass
// show what is behind them.
Canvas shadeView(const RayScene& rays, unsigned samplesPerAxis);

// The dots that can be seen, in row order.
// Throws InputError when the colour needs a column that the rows do not have.
std::vector<Dot> visibleDots(const VplTable& table, const RayScene& rays,
                             const PlotOptions& options, PlotCounts& counts);

}  // namespace bnvpl
