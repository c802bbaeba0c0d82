// How many samples a pass over the film can have.
#pragma once

#include "tools/render/film/film.h"

namespace bnvpl {

// Limit of samples per pixel in a pass.
inline constexpr uint64_t kMaxPassSpp = uint64_t{1} << 20;

// 4, 2 or 1 samples per pixel: the first that fits. With them `passes` passes take at most `timeS`
// seconds, together with what tiles learn in the first; 1 is taken even where it does not fit. A
// trial on tiles all over the film, whose samples are thrown away, tells their time. Small films
// are not worth a trial, and have kPassSpp (4).
uint32_t sppThatFits(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                     double timeS, double passes);

}  // namespace bnvpl
