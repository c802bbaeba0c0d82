// Renders an image by passes over the film, until a time is spent or an error is reached.
//
// Each pass renders an image m_k with some samples per pixel (PassBudget::passSpp) and its own
// random numbers. The result is the plain mean m of all K passes. The variance between samples of
// one pass does not give the error, as samples of a tile share a cut and are stratified. Passes are
// independent, so the variance between passes does, for each pixel:
//
//   error^2 = sum over passes (m_k - m)^2 / (K (K - 1))
//
// This is the error before fireflies are redistributed (fireflies.h). It does not include the error
// of what all passes share: VPLs, their flux, and choices that a gather makes once for the film.
//
// Adaptive passes give each tile its own number of samples, passSpp on average, from the error of
// the passes before. This adds no bias: every pass is unbiased whatever was chosen, and its weight
// is 1 / K whatever it finds and however many samples a tile has. (Weights by the number of samples
// would be biased: a pixel that met no bright sample by chance would get no others, and stay too
// dark.) The error above stays valid: the m_k - E[m_k] are steps of a martingale, so they are
// uncorrelated, though of different variances. Only --target-error lets the estimate end the work:
// an image that has met no firefly yet tells a small error and ends early, one that has goes on, so
// that rare light is too dark on average (tools/render/film/theory.md).
#pragma once

#include <cmath>
#include <string_view>

#include "tools/render/film/film.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

inline constexpr uint32_t kPassSpp = 4;  // samples per pixel in a pass, if nothing else is asked

struct PassBudget {
  // Wall-clock time since startS, of nowS(). A pass begins only if it is expected to fit.
  double timeS = INFINITY;
  double startS = nowS();
  double error = 0.0;            // relativeError() that ends the work; 0: none does
  uint64_t passes = UINT64_MAX;  // maximal number of passes, at least kMinPasses
  uint64_t spp = UINT64_MAX;     // maximal number of samples per pixel, on average
  // Samples per pixel in a pass, on average. 0: kPassSpp, or fewer where a trial on some tiles
  // tells that ten passes of so many would not fit into the time.
  uint32_t passSpp = kPassSpp;
  bool adaptive = true;  // ignored with photons, which cannot be aimed at tiles
};

struct PassesDone {
  uint64_t passes = 0;
  double error = 0.0;  // relativeError() of the image
  double timeS = 0.0;  // since the start
  uint32_t passSpp = kPassSpp;
  std::string_view endedBy;  // "time", "error" or "passes"
};

// Like renderFilm(), but ignores options.spp. The image depends only on the number of passes and of
// their samples, down to its bytes. The first preview comes after a second, or a tenth of the time.
Image renderPasses(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                   const PassBudget& budget, FilmStats& stats, PassesDone& passes,
                   const ProgressFn& progress = {}, const WorkControls& controls = {},
                   const FilmPreview& preview = {});

}  // namespace bnvpl
