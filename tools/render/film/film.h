// The film: samples of an integrator -> an image with layers.
#pragma once

#include <functional>
#include <optional>

#include "core/progress.h"
#include "core/work_controls.h"
#include "formats/image/image.h"
#include "scene/scene.h"
#include "tools/render/film/features/first_hits.h"
#include "tools/render/film/film_preview.h"
#include "tools/render/film/filter/gather_filter.h"
#include "tools/render/film/integrator.h"
#include "tools/render/film/layers.h"
#include "tools/render/pixel_filter.h"

namespace bnvpl {

struct FilmOptions {
  uint32_t spp = 8;  // samples per pixel
  uint64_t seed = 1;
  ShownLight shown = ShownLight::All;
  std::vector<const Layer*> layers;    // channels beside R, G, B
  bool redistributeFireflies = false;  // see fireflies.h; not with a crop
  PixelFilter filter = {};
  std::optional<PixelBox> crop = {};  // the pixels of the image; none: all
  FirstHitValues firstHits = {};      // traceFirstHits(); unused by joinFilm()
  GatherFilter gatherFilter = {};     // smooths RadianceSample::toFilter
  std::vector<std::string> groups = {};  // light groups to show; empty: none
};

struct FilmStats {
  // Means over pixels and channels, W/(m2 sr).
  double direct = 0, indirect = 0, clamped = 0, compensated = 0;
  double cut = 0, shadowRays = 0;          // means per sample
  std::array<double, kMaxCounters> own{};  // the same of the methods' own counters
  uint64_t samples = 0;
  uint64_t nonFinite = 0;  // samples counted as zero because a value was NaN or infinite
};

// Sum of channel `c` of the light that the image shows.
inline double shownRadiance(const PixelSums& p, ShownLight shown, size_t c) {
  return (shown != ShownLight::Indirect ? p.sum[PixelSums::kDirect + c] : 0.0) +
         (shown != ShownLight::Direct ? p.sum[PixelSums::kIndirect + c] : 0.0);
}

// Mean radiance that the image shows after `samples` samples of the pixel.
inline Vec3 meanRadiance(const PixelSums& p, ShownLight shown, double samples) {
  Vec3 mean;
  for (size_t c = 0; c < 3; ++c) mean[c] = static_cast<float>(shownRadiance(p, shown, c) / samples);
  return mean;
}

// The pixels whose samples the image needs; none: all.
std::optional<PixelBox> sampledPixels(const Film& film, const FilmOptions& options);

// Renders with samples that are stratified in each pixel and spread like its filter. A tile depends
// only on the seed and its position, so that a crop has the pixels of the whole image. Progress
// counts samples and photons. The state of `controls` holds the sums of every pixel. A shard
// returns a blank image; the sums of its tiles and of its photons go to the sink.
Image renderFilm(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                 FilmStats& stats, const ProgressFn& progress = {},
                 const WorkControls& controls = {}, const FilmPreview& preview = {});

// Develops the image from the sums of all shards. `photons`: whether the integrator traces photons.
Image joinFilm(const Film& film, const FilmOptions& options, bool photons, FilmStats& stats,
               const ShardSource& source);

}  // namespace bnvpl
