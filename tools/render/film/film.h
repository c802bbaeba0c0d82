// The stage vpl-render without files: a scene and lit VPLs -> an image with layers.
#pragma once

#include <functional>

#include "core/progress.h"
#include "core/resume.h"
#include "formats/image.h"
#include "tools/render/film/splats.h"
#include "tools/render/integrators.h"

namespace bnvpl {

// Layers beside R, G, B; each a bit.
enum LayerBits : unsigned {
  kLayerDirect = 1,
  kLayerIndirect = 2,
  kLayerAlbedo = 4,
  kLayerNormal = 8,
  kLayerDepth = 16,
  kLayerCutSize = 32,
  kLayerShadowRays = 64,
  kLayerClamped = 128,
};

struct FilmOptions {
  uint32_t spp = 8;  // samples a pixel
  uint64_t seed = 1;
  Only only = Only::Everything;
  unsigned layers = 0;  // LayerBits
};

struct FilmStats {
  double direct = 0, indirect = 0, clamped = 0,
         extended = 0;             // image means of the channels' mean, W/(m2 sr)
  double cut = 0, shadowRays = 0;  // a sample, on average
  uint64_t samples = 0;
  uint64_t nonFinite = 0;  // samples counted as zero because a value was NaN or infinite
};

// Finds the radiance of all samples of a tile.
using Integrator = std::function<void(const TileSamples& tile)>;

// What makes a film: samples of its pixels, and photons that bring indirect light besides, as many
// as samples; none where `photons` is empty.
struct FilmSources {
  Integrator samples;
  Splatter photons = {};
};

// Box filter, samples stratified in each pixel. A tile depends on the seed and its place only.
// Progress counts samples and photons; `resume` mends interruptions, and its state holds every
// pixel's sums.
Image renderFilm(const Scene& scene, const FilmSources& sources, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress = {}, const Resume& resume = {});

}  // namespace bnvpl
