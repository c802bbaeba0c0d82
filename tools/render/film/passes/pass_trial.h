// How many samples a pass over the film can have.
#pragma once

#include "tools/render/film/film.h"

namespace bnvpl {

// Limit of samples per pixel in a pass.
inline constexpr uint64_t kMaxPassSpp = uint64_t{1} << 20;

// The most samples per pixel, at most kPassSpp and at least 1, with which `passes` passes take at
// most `timeS` seconds, together with what tiles learn in the first. A trial on tiles all over the
// film, whose samples are thrown away, tells their time. Small films are not worth a trial, and
// have kPassSpp.
uint32_t sppThatFits(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                     double timeS, double passes);

}  // namespace bnvpl
