#include "tools/inspect/contributions/contributions.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "transport/camera.h"
#include "transport/virtual_light/virtual_light.h"
#include "transport/walk.h"

namespace bnvpl {
namespace {

constexpr uint32_t kMaxBands = 32;

float meanChannel(Vec3 v) { return (v.x + v.y + v.z) / 3.0f; }

// Adds the light of every VPL that leaves a point towards the camera, times `weight`, by row.
void addLight(const Accelerator& accel, const VplLights& vpls, const Bsdf& bsdf, Vec3 weight,
              std::vector<float>& ofRow) {
  const Vec3 from = accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  VplTransfer c;
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (!unoccludedTransfer(vpls, i, bsdf, c)) continue;
    if (accel.occluded(from, vpls.position[i])) continue;
    ofRow[vpls.row[i]] += meanChannel(weight * c.transfer * vpls.intensity[i]);
  }
}

// Follows a camera ray over specular lobes. Every surface on the way that has others receives.
void addPath(const Accelerator& accel, const VplLights& vpls, Ray ray, Rng& rng,
             std::vector<float>& ofRow) {
  Vec3 weight(1.0f);
  SurfacePoint hit;
  for (unsigned depth = 0; depth <= kMaxSpecular; ++depth) {
    if (!accel.closestHit(ray.origin, ray.direction, hit)) return;
    const Bsdf bsdf(accel.scene(), hit);
    if (bsdf.hasRough()) addLight(accel, vpls, bsdf, weight, ofRow);
    BsdfSample sample;
    if (bsdf.specularProbability() <= 0.0f ||
        !sampleNextRay(accel, bsdf, LobeGroup::Specular, TransportMode::Radiance, rng, sample, ray))
      return;
    weight = weight * sample.weight;
  }
}

PixelContributions strongest(const std::vector<float>& ofRow, size_t count) {
  PixelContributions out;
  std::vector<uint32_t> rows;
  double sum = 0.0;
  for (size_t i = 0; i < ofRow.size(); ++i) {
    if (!(ofRow[i] > 0.0f)) continue;
    rows.push_back(static_cast<uint32_t>(i));
    sum += double{ofRow[i]};
  }
  const auto before = [&](uint32_t a, uint32_t b) {
    return ofRow[a] != ofRow[b] ? ofRow[a] > ofRow[b] : a < b;
  };
  const size_t kept = std::min(count, rows.size());
  std::partial_sort(rows.begin(), rows.begin() + std::ptrdiff_t(kept), rows.end(), before);
  rows.resize(kept);
  out.radiance = static_cast<float>(sum);
  for (const uint32_t row : rows)
    out.shares.push_back(static_cast<float>(double{ofRow[row]} / sum));
  out.rows = std::move(rows);
  return out;
}

}  // namespace

Contributions contributionsOf(const Accelerator& accel, const VplTable& lit,
                              const ContributionOptions& options, const ProgressFn& progress) {
  const VplLights vpls = makeVplLights(lit, accel, options.clamp);
  const Camera& camera = accel.scene().camera;
  const Film& film = options.film;
  const unsigned n = options.samplesPerAxis;
  const uint64_t key = streamKey(0, RandomStream::Contributions);
  Contributions out{film, std::vector<PixelContributions>(size_t{film.width} * film.height), {}};

  const auto addPixel = [&](size_t x, size_t y, std::vector<float>& ofRow) {
    Rng rng(key, y * film.width + x);
    for (unsigned s = 0; s < n * n; ++s) {
      const auto at = [n](size_t pixel, unsigned sub, uint32_t size) {
        return (static_cast<float>(pixel) +
                (static_cast<float>(sub) + 0.5f) / static_cast<float>(n)) /
               static_cast<float>(size);
      };
      const Vec3 lens = sampleLens(camera, [&] { return rng.nextPoint(); });
      const Ray ray =
          cameraRay(camera, film, at(x, s % n, film.width), at(y, s / n, film.height), lens);
      addPath(accel, vpls, ray, rng, ofRow);
    }
    for (float& light : ofRow) light /= static_cast<float>(n * n);
  };

  // Each band of the film has sums of its own, which are added in order.
  std::vector<std::vector<double>> bands(std::min(kMaxBands, film.height));
  parallelFor(bands.size(), 1, [&](size_t band) {
    bands[band].assign(lit.size(), 0.0);
    std::vector<float> ofRow(lit.size());
    for (size_t y = band; y < film.height; y += bands.size()) {
      for (size_t x = 0; x < film.width; ++x) {
        std::ranges::fill(ofRow, 0.0f);
        addPixel(x, y, ofRow);
        for (size_t i = 0; i < ofRow.size(); ++i) bands[band][i] += double{ofRow[i]};
        out.pixels[y * film.width + x] = strongest(ofRow, options.perPixel);
      }
      if (progress) progress(1);
    }
  });
  out.radiance.assign(lit.size(), 0.0);
  for (const std::vector<double>& sums : bands) {
    for (size_t i = 0; i < sums.size(); ++i) out.radiance[i] += sums[i];
  }
  for (double& mean : out.radiance) mean /= static_cast<double>(out.pixels.size());
  return out;
}

double memoryOfContributions(const ContributionOptions& options, size_t rows) {
  constexpr double kOfPixel = 200, kOfListed = 150;  // measured: 140 to 153 for each listed VPL
  const auto all = static_cast<double>(rows);
  const double pixels = double(options.film.width) * double(options.film.height);
  const double bands = std::min(kMaxBands, options.film.height) * (sizeof(double) + sizeof(float));
  return pixels * (kOfPixel + kOfListed * std::min(all, double(options.perPixel))) + bands * all;
}

Film contributionFilm(const Film& scene) {
  Film film = scene;
  film.width = kContributionColumns;
  film.height = std::max(1u, static_cast<uint32_t>(std::lround(double{kContributionColumns} *
                                                               scene.height / scene.width)));
  return film;
}

}  // namespace bnvpl
