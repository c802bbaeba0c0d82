#include "tools/render/tile/pixel_control.h"

#include "core/parallel.h"

namespace bnvpl {

namespace {

// What the VPLs say has noise of its own, which neighbouring regions do not share: only where
// pixels differ by more than that is there something to control.
constexpr double kLeast = 0.2;
// Pixels differ from those around: all that these would allow could take more light than there is.
constexpr double kCaution = 0.5;
// Pixels of the tile on each side that tell how far light follows it.
constexpr uint32_t kAround = 2;
// Of the mean light there, the most that counts of what VPLs say. They stand for surfaces, of which
// a part may lie in the dark: what is not there cannot be taken away.
constexpr double kMost = 2.0;

}  // namespace

PixelControl::PixelControl(const RayScene& rays, const LightSet& lights, const FilmPoints& film,
                           const VplTable& lit)
    : scene_(rays.scene()),
      field_(lit),
      pixels_(rays, lights, film, saidOf(film), kLeast, kDrawRays) {}

Vec3 PixelControl::said(const SpecularPath& path) const {
  if (!path.rough) return {};
  return path.throughput * Bsdf(scene_, path.hit).roughAlbedo() *
         field_.indirectAt(path.hit.position, path.hit.ng);
}

std::vector<float> PixelControl::saidOf(const FilmPoints& film) const {
  std::vector<float> values(film.points.size());
  parallelFor(values.size(), 1024, [&](size_t i) {
    const SurfacePoint& hit = film.points[i];
    if (hit.triangle == kNone) return;
    values[i] = mean(Bsdf(scene_, hit).roughAlbedo() * field_.indirectAt(hit.position, hit.ng));
  });
  return values;
}

namespace {

// Samples by their light l and by what VPLs say v: sums, and products of deviations from the means
// of the pixels.
struct Follows {
  double n = 0.0, l = 0.0, v = 0.0, lv = 0.0, vv = 0.0;

  void add(const Follows& o) { n += o.n, l += o.l, v += o.v, lv += o.lv, vv += o.vv; }
  double most() const { return n > 0.0 ? kMost * l / n : 0.0; }
  // What share of v is to be found again in l: neither more than varies with it, nor more than
  // there is.
  double share() const {
    if (!(lv > 0.0 && vv > 0.0 && l > 0.0 && v > 0.0)) return 0.0;
    return kCaution * std::min({1.0, lv / vv, l / v});
  }
};

// How a pixel is controlled.
struct Control {
  float share = 0.0f, most = 0.0f;
  Vec3 of(Vec3 said) const {
    const float m = mean(said);
    return said * (m > most ? share * most / m : share);
  }
};

class Deviations {
 public:
  void add(double l, double v) { n_ += 1.0, l_ += l, v_ += v, lv_ += l * v, vv_ += v * v; }
  Follows of() const {
    return n_ > 0.0 ? Follows{n_, l_, v_, lv_ - l_ * v_ / n_, vv_ - v_ * v_ / n_} : Follows{};
  }

 private:
  double n_ = 0.0, l_ = 0.0, v_ = 0.0, lv_ = 0.0, vv_ = 0.0;
};

}  // namespace

void PixelControl::apply(const TileSamples& tile, std::span<const SpecularPath> paths) const {
  bool any = false;
  for (uint32_t p = 0; p < tile.pixels && !any; ++p) any = pixels_.count(tile, p) > 0;
  if (!any) return;
  const size_t count = paths.size();
  std::vector<Vec3> saids(count);
  // The samples of a pixel; single ones with those of the next pixel.
  const uint32_t side = count > tile.pixels ? 1 : 2;
  std::vector<Deviations> groups((tile.pixels + side - 1) / side);
  for (size_t i = 0; i < count; ++i) {
    saids[i] = said(paths[i]);
    groups[i % tile.pixels / side].add(double{mean(tile.samples[i].radiance.indirect)},
                                       double{mean(saids[i])});
  }
  const auto controlOf = [&](uint32_t pixel) {
    const uint32_t x = pixel % tile.width, y = pixel / tile.width,
                   height = tile.pixels / tile.width;
    Follows around;
    for (uint32_t v = y - std::min(y, kAround); v < std::min(height, y + kAround + 1); ++v) {
      for (uint32_t u = x - std::min(x, kAround); u < std::min(tile.width, x + kAround + 1); ++u) {
        const uint32_t group = (v * tile.width + u) / side;
        if (group != pixel / side) around.add(groups[group].of());
      }
    }
    return Control{static_cast<float>(around.share()), static_cast<float>(around.most())};
  };
  std::vector<Control> controls(tile.pixels);
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    if (pixels_.count(tile, p) > 0) controls[p] = controlOf(p);
  }
  for (size_t i = 0; i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    const Control& control = controls[pixel];
    if (!(control.share > 0.0f)) continue;
    Vec3 sum;
    pixels_.forEach(
        tile, pixel, tile.firstSlot + static_cast<uint32_t>(i / tile.pixels), {},
        [&](const SpecularPath& path, const RadianceSample&) { sum += control.of(said(path)); });
    tile.samples[i].radiance.indirect +=
        sum * (1.0f / static_cast<float>(pixels_.count(tile, pixel))) - control.of(saids[i]);
  }
}

}  // namespace bnvpl
