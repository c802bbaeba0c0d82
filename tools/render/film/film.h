// The film: samples of an integrator -> an image with layers.
#pragma once

#include <functional>

#include "core/progress.h"
#include "core/resume.h"
#include "formats/image.h"
#include "scene/scene.h"
#include "tools/render/film/integrator.h"
#include "tools/render/film/layers.h"

namespace bnvpl {

struct FilmOptions {
  uint32_t spp = 8;  // samples a pixel
  uint64_t seed = 1;
  Only only = Only::Everything;
  std::vector<const Layer*> layers;    // channels beside R, G, B
  bool redistributeFireflies = false;  // fireflies.h
};

struct FilmStats {
  double direct = 0, indirect = 0, clamped = 0,
         compensated = 0;          // image means of the channels' mean, W/(m2 sr)
  double cut = 0, shadowRays = 0;  // a sample, on average
  uint64_t samples = 0;
  uint64_t nonFinite = 0;  // samples counted as zero because a value was NaN or infinite
};

// Channel `c` of what the image shows, as the sums have it.
inline double shownRadiance(const PixelSums& p, Only only, size_t c) {
  return (only != Only::Indirect ? p.sum[PixelSums::kDirect + c] : 0.0) +
         (only != Only::Direct ? p.sum[PixelSums::kIndirect + c] : 0.0);
}

// Box filter, samples stratified in each pixel. A tile depends on the seed and its place only.
// Progress counts samples and photons; `resume` mends interruptions, and its state holds every
// pixel's sums. The image of a shard is blank: what it brought goes to the sink, the sums of each
// of its tiles, and of all that its photons bring.
Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress = {}, const Resume& resume = {});

// The image from the sums of all shards. `photons`: whether the integrator sends any.
Image joinFilm(const Film& film, const FilmOptions& options, bool photons, FilmStats& stats,
               const ShardSource& source);

}  // namespace bnvpl
