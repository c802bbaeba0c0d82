// Fireflies: single samples or photons that are far brighter than the surroundings of their pixel.
//
// A sample of a bright path that has a small probability carries the energy of the many samples
// that miss it. The estimate is unbiased, but the pixel is white. Here the excess of such a sample
// is redistributed over the surface around, as widely as is needed to make it invisible there (in
// the manner of Rushmeier and Ward, Energy preserving non-linear filters, SIGGRAPH 1994, with an
// edge-stopping filter):
//
//   b_i    = max(1/8, 2/n) max(o_i, a_i)  bound of the contribution of one of n samples to pixel i;
//            twice as much for direct light
//   e_i    = excess of the two brightest samples and photons over b_i, with their sign
//   M_l, Y_l = S_l ... S_0 applied to the surface's light L and to e (surface_filter.h)
//   r_j   += sum over i of  L_j e_i / M_l(i) K_l(i, j),   K_l being the kernel of S_l ... S_0
//
// o is the pixel's value without these samples and a the mean of its surroundings, both averaged
// over the channels. l is the narrowest level at which the added light is invisible,
//
//   P_l |e_i| <= kVisible (M_l + Y_l)
//
// where P_l is the peak of K_l. Fireflies that pixels of a tile share are hidden together. If no
// level suffices, l is the one with the smallest contrast. On small or bumpy surfaces, whose edges
// leave too few pixels, that may be a level of a filter that ignores edges. Division by M_l makes
// up for the weight that edges remove from K_l, so the sum over the film is preserved in each
// channel. A firefly stays where it is if M_l is 0, as on the background or in the dark. Pixel
// filters with negative lobes make negative ones, which would be black dots.
//
// With more samples each contributes less, so the method is consistent. Its bias removes noise, but
// also edges of light that few samples of a pixel hit. Directly visible emission has such edges; it
// is left alone.
#pragma once

#include <array>
#include <vector>

#include "core/vec3.h"
#include "tools/render/film/film_sums.h"
#include "tools/render/sample.h"

namespace bnvpl {

// Change of each pixel's direct and indirect light, W/(m2 sr), for a film whose rows have `width`
// pixels. Light that is not `shown` does not change.
// `groups`: where film.groups is set, receives the change of each light group of each pixel.
std::vector<BothLights> redistributeFireflies(const FilmSums& film, ShownLight shown,
                                              uint32_t width, std::vector<Vec3>* groups = nullptr);

}  // namespace bnvpl
