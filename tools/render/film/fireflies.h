// Fireflies: light that one sample of a pixel, or one photon, finds far above all around it.
//
// A sample that finds a small bright place by a small chance brings the energy of the many that
// missed it. The image is right on average, and a white pixel. Here the excess of such a sample
// goes to the surface around, as widely as it takes to be invisible there (in the manner of
// Rushmeier and Ward, Energy preserving non-linear filters, SIGGRAPH 1994, with an edge-stopping
// filter):
//
//   b_i    = max(1/8, 2/n) max(o_i, a_i)  bound on what one of n samples adds to pixel i; twice as
//            much for direct light
//   e_i    = what the two brightest samples and photons add beyond
//   M_l, Y_l = S_l ... S_0 of the light a, and of e (surface_filter.h)
//   r_j   += sum over i of  a_j e_i / M_l(i) K_l(i, j),   K_l being the kernel of S_l ... S_0
//
// o is what a pixel shows without these samples and a what is around it, by the mean of the
// channels. l is the narrowest level at which the lump does not show,
//
//   P_l e_i <= kVisible (M_l + Y_l)
//
// where P_l is the peak of K_l. Those that pixels of a tile owe to one find are hidden together. If
// no level is enough, l is the one with the least contrast; on small or bumpy surfaces, whose edges
// leave too little room, that may be a level of a filter that ignores them. M_l holds what edges
// take from K_l, so the sum over the film stays as it is, for each channel. A firefly in the void
// or in the dark, where M_l is 0, stays where it was found.
//
// With more samples each adds less, and the image converges to the same as without: what the bias
// takes is noise, and edges of light that few samples of a pixel meet. Lights that the camera sees
// straight have such edges; they are left alone.
#pragma once

#include <array>
#include <vector>

#include "core/vec3.h"
#include "tools/render/film/film_sums.h"
#include "tools/render/sample.h"

namespace bnvpl {

// What each pixel's direct and indirect light change by, in W/(m2 sr), for a film of rows of
// `width` pixels that shows what `only` says. What is not shown stays as it is.
std::vector<BothLights> redistributeFireflies(const FilmSums& film, Only only, uint32_t width);

}  // namespace bnvpl
