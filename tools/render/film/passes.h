// An image by passes over the film, until a time is spent or an error is reached.
//
// A pass is an image of its own, by kPassSpp samples a pixel, with random numbers of its own; the
// image is the plain mean of all K passes m_k. How samples of one pass differ tells nothing about
// the error, as those of a tile share a cut and are stratified. Passes are independent, so how they
// differ tells the error of their mean m, for each pixel:
//
//   error^2 = sum over passes (m_k - m)^2 / (K (K - 1))
//
// It is the error of the samples, before fireflies are redistributed (fireflies.h), and knows
// nothing of what all passes share: VPLs, their flux, and choices that a gather makes once for the
// film.
//
// Adaptive passes give each tile its own number of samples, kPassSpp on average, by the error of
// the passes before. That is free of bias: whatever was chosen, a pass is right on average, and
// its weight is 1 / K whatever it finds and however many samples a tile got. (Weights by the number
// of samples would be biased: a pixel that met no bright sample by chance would get no others, and
// stay too dark.) For the same reason the error above is right: m_k - expectation are a
// martingale's steps, uncorrelated though of different variances, and that is all it needs.
// What is left: an error to be reached ends the work when the estimate says so. It is one number
// for the whole image, on which a single pixel has next to no influence.
#pragma once

#include <cmath>
#include <string_view>

#include "tools/render/film/film.h"

namespace bnvpl {

inline constexpr uint32_t kPassSpp = 4;    // samples a pixel of a pass, on average
inline constexpr uint64_t kMinPasses = 2;  // for an error to be known

struct Budget {
  double timeS = INFINITY;  // of the passes, by the clock; no pass begins that is expected to end
                            // later
  double error = 0.0;       // ends when relativeError() is at most this; 0: never
  uint64_t passes = UINT64_MAX;  // at most; at least kMinPasses
  bool adaptive = true;          // not with photons, which go where they will
};

struct PassesDone {
  uint64_t passes = 0;
  double error = 0.0;  // relativeError() of the image
  double timeS = 0.0;
  std::string_view endedBy;  // "time", "error" or "passes"
};

// Gets R, G, B of the image so far, every few seconds.
using PreviewFn = std::function<void(const Image&)>;

// As renderFilm(), whose count of samples it ignores. Of the number of passes alone depends what
// the image is, bytes included.
Image renderPasses(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                   const Budget& budget, FilmStats& stats, PassesDone& passes,
                   const ProgressFn& progress = {}, const Resume& resume = {},
                   const PreviewFn& preview = {});

}  // namespace bnvpl
