// Specks: light that one sample of a pixel found and that stands far above all around it.
//
// A sample that finds a small bright place by a small chance brings the energy of the many that
// missed it. The image is right on average, and a white pixel. Here the excess of such a sample
// goes to the pixels around, as widely as it takes to be invisible there (Rushmeier and Ward,
// Energy preserving non-linear filters, SIGGRAPH 1994):
//
//   b_i  = max(1/8, 2/n) max(o_i, a_i)   the most that one of n samples adds to pixel i; of direct
//          light twice as much
//   e_i  = what the two brightest samples add above b_i each
//   W_i  = sum of a over a square window around i, of radius 2, 4, 8, ... pixels, the first with
//          e_i <= W_i / 50; of indirect light, with the sum of e over the pixels around that may
//          share a find with i <= W_i / 50
//   r_j += sum over i, j in the window of i, of a_j e_i / W_i
//
// for direct and for indirect light, whose brightest samples are each their own. o is what a pixel
// shows without these four, a the mean of what 5 x 5 pixels show, by the mean of the channels. In
// b_i a is without the brightest samples of i, in W_i and the last line without e_i; of all other
// specks it is with: where all is noise, the energy stays in its place. The sum over the film stays
// as it is, for each channel.
//
// No speck brightens a place by more than 1/50, the contrast that one sees, nor do all specks
// together that pixels owe to one find (shareHits); a dark pixel beside a bright one is brightened
// by 1/50 of their mean, and the void not at all. With more samples each adds less, and the image
// converges to the same as without: what the bias takes is noise, and edges of light that few
// samples of a pixel meet. Lights that the camera sees straight have such edges; they are left
// alone. What a window as large as the film cannot hide stays where it was found.
//
// Caustic photons, which come for the whole film, are spread likewise on their own (Caustics).
#pragma once

#include <array>
#include <vector>

#include "core/vec3.h"
#include "tools/render/film/develop.h"
#include "tools/render/tile.h"

namespace bnvpl {

// Pixels to each side that share what near-field rays find: those of a block.
inline constexpr size_t kSharedFinds = kBlockSide - 1;

// What each pixel's direct and indirect light change by, in W/(m2 sr), for a film of rows of
// `width` pixels that shows what `only` says. What is not shown stays as it is. `together`: pixels
// to each side that may share a find.
std::vector<BothLights> spreadSpecks(const Exposed& film, Only only, uint32_t width,
                                     size_t together);

}  // namespace bnvpl
