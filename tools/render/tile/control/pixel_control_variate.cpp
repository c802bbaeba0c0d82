#include "tools/render/tile/control/pixel_control_variate.h"

#include "core/parallel.h"

namespace bnvpl {

namespace {

// Predictions have noise of their own, which neighbouring regions of the field do not share. Where
// pixels deviate by less than this share of their mean, there is nothing to control.
constexpr double kMinDeviation = 0.2;
// Pixels differ from those around them. The full regression coefficient could subtract more light
// than there is.
constexpr double kCaution = 0.5;
// Pixels on each side whose samples give the regression coefficient.
constexpr uint32_t kAround = 2;
// Largest prediction, over the mean light around. A prediction holds for a whole surface, of which
// a part may be in shadow.
constexpr double kMaxPrediction = 2.0;

}  // namespace

PixelControlVariate::PixelControlVariate(const Accelerator& accel, const LightSet& lights,
                                         const PixelFilter& filter, const FilmPoints& filmPoints,
                                         const VplTable& lit, const VplGroups& groups)
    : scene_(accel.scene()),
      field_(lit, groups),
      pixels_(accel, lights, filter, filmPoints, predictedAt(filmPoints), kMinDeviation,
              kDimControlRays) {}

Vec3 PixelControlVariate::predicted(const SpecularPath& path) const {
  if (!path.rough) return {};
  return path.throughput * Bsdf(scene_, path.hit).roughAlbedo() *
         field_.indirectAt(path.hit.position, path.hit.ng);
}

// Adds the prediction by light group, times `factor`.
void PixelControlVariate::addByGroup(const SpecularPath& path, float factor,
                                     const LightGroupSink& sink) const {
  if (!sink || !path.rough) return;
  const Vec3 reflected = path.throughput * Bsdf(scene_, path.hit).roughAlbedo();
  field_.addByGroup(path.hit.position, path.hit.ng, sink.times(reflected * factor));
}

std::vector<float> PixelControlVariate::predictedAt(const FilmPoints& filmPoints) const {
  std::vector<float> values(filmPoints.points.size());
  parallelFor(values.size(), 1024, [&](size_t i) {
    const SurfacePoint& hit = filmPoints.points[i];
    if (hit.triangle == kNone) return;
    values[i] = mean(Bsdf(scene_, hit).roughAlbedo() * field_.indirectAt(hit.position, hit.ng));
  });
  return values;
}

namespace {

// Light l and prediction v of samples: sums, and sums of products of their deviations from the
// pixel's means.
struct Covariance {
  double n = 0.0, l = 0.0, v = 0.0, lv = 0.0, vv = 0.0;

  void add(const Covariance& o) { n += o.n, l += o.l, v += o.v, lv += o.lv, vv += o.vv; }
  double maxPrediction() const { return n > 0.0 ? kMaxPrediction * l / n : 0.0; }
  // Regression coefficient of l on v, at most the ratio of the means.
  double beta() const {
    if (!(lv > 0.0 && vv > 0.0 && l > 0.0 && v > 0.0)) return 0.0;
    return kCaution * std::min({1.0, lv / vv, l / v});
  }
};

// Samples of a pixel, one after the other.
class CovarianceSums {
 public:
  void add(double l, double v) { n_ += 1.0, l_ += l, v_ += v, lv_ += l * v, vv_ += v * v; }
  Covariance covariance() const {
    return n_ > 0.0 ? Covariance{n_, l_, v_, lv_ - l_ * v_ / n_, vv_ - v_ * v_ / n_} : Covariance{};
  }

 private:
  double n_ = 0.0, l_ = 0.0, v_ = 0.0, lv_ = 0.0, vv_ = 0.0;
};

// The variate of a pixel: beta times the prediction, which is clamped. Predictions include the
// weight of the pixel filter, the bound does not.
struct Variate {
  float beta = 0.0f, maxPrediction = 0.0f;
  float factor(Vec3 predicted, float weight) const {
    const float m = mean(predicted) / weight;
    return m > maxPrediction ? beta * maxPrediction / m : beta;
  }
};

// `pools`: sums over `side` pixels of a row each.
Variate variateOf(const TileLayout& tile, uint32_t pixel, uint32_t side,
                  std::span<const CovarianceSums> pools) {
  const uint32_t x = pixel % tile.width, y = pixel / tile.width, height = tile.pixels / tile.width;
  Covariance around;
  for (uint32_t v = y - std::min(y, kAround); v < std::min(height, y + kAround + 1); ++v) {
    for (uint32_t u = x - std::min(x, kAround); u < std::min(tile.width, x + kAround + 1); ++u) {
      const uint32_t pool = (v * tile.width + u) / side;
      if (pool != pixel / side) around.add(pools[pool].covariance());
    }
  }
  return {static_cast<float>(around.beta()), static_cast<float>(around.maxPrediction())};
}

}  // namespace

void PixelControlVariate::apply(const TileSamples& tile,
                                std::span<const SpecularPath> paths) const {
  bool any = false;
  for (uint32_t p = 0; p < tile.pixels && !any; ++p) any = pixels_.count(tile, p) > 0;
  if (!any) return;
  const size_t count = paths.size();
  std::vector<Vec3> predictions(count);
  // A pixel with a single sample has no deviations: it forms a pool with its neighbour.
  const uint32_t side = count > tile.pixels ? 1 : 2;
  std::vector<CovarianceSums> pools((tile.pixels + side - 1) / side);
  for (size_t i = 0; i < count; ++i) {
    predictions[i] = predicted(paths[i]);
    const CameraSample& sample = tile.samples[i];
    pools[i % tile.pixels / side].add(
        double{mean(unweightedIndirect(sample.radiance, sample.weight))},
        double{mean(unweighted(predictions[i], sample.weight))});
  }
  std::vector<Variate> variates(tile.pixels);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    if (pixels_.count(tile, p) > 0) variates[p] = variateOf(tile, p, side, pools);
  }
  for (size_t i = 0; i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    const Variate& variate = variates[pixel];
    if (!(variate.beta > 0.0f)) continue;
    Vec3 sum;
    const float each = 1.0f / static_cast<float>(pixels_.count(tile, pixel));
    const LightGroupSink byGroup = tile.samples[i].groups.indirect();
    pixels_.forEach(tile, pixel, tile.sampleIndex(i), {.wanted = false},
                    [&](const SpecularPath& path, const RadianceSample&, float weight) {
                      const Vec3 prediction = predicted(path);
                      const float factor = variate.factor(prediction, weight);
                      sum += prediction * factor;
                      addByGroup(path, factor * each, byGroup);
                    });
    const float factor = variate.factor(predictions[i], tile.samples[i].weight);
    tile.samples[i].radiance.indirect += sum * each - predictions[i] * factor;
    addByGroup(paths[i], -factor, byGroup);
  }
}

}  // namespace bnvpl
