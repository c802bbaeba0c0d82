#include "tools/inspect/plot/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "formats/image/tonemap.h"
#include "formats/vpl/vpl_io.h"
#include "tools/inspect/display_colour.h"
#include "tools/inspect/rows_in_view.h"
#include "transport/camera.h"
#include "transport/walk.h"

namespace bnvpl {
namespace {

constexpr unsigned kMaxMirrors = 8;           // max number of specular bounces
constexpr float kDim = 0.4f;                  // dims the view, so that dots stand out
constexpr Vec3 kSky{0.16f, 0.19f, 0.24f};     // linear; for rays that leave the scene
constexpr Vec3 kPlainDot{1.0f, 0.84f, 0.2f};  // sRGB

Vec3 shadeRay(const Accelerator& accel, Vec3 origin, Vec3 direction, Rng& rng) {
  Vec3 weight(1.0f);
  SurfacePoint hit;
  for (unsigned depth = 0; depth <= kMaxMirrors; ++depth) {
    if (!accel.closestHit(origin, direction, hit)) return weight * kSky;
    const Bsdf bsdf(accel.scene(), hit);
    const Material& material = accel.scene().materials[hit.material];
    if (!isBlack(material.emission) && (hit.front || material.twoSidedEmission)) return weight;
    if (bsdf.hasRough() || bsdf.specularProbability() <= 0.0f) {
      const float headlight = std::max(0.0f, dot(hit.ns, hit.wo));
      return weight * bsdf.roughAlbedo() * ((0.2f + 0.8f * headlight) * kDim);
    }
    BsdfSample sample;
    Ray next;
    if (!sampleNextRay(accel, bsdf, LobeGroup::Specular, TransportMode::Radiance, rng, sample,
                       next))
      return {};
    weight = weight * sample.weight;
    origin = next.origin;
    direction = next.direction;
  }
  return {};
}

Vec3 encoded(Vec3 linear) {
  return {encodeSrgb(linear.x), encodeSrgb(linear.y), encodeSrgb(linear.z)};
}

// A perceptually even ramp from violet (t = 0) to yellow (t = 1), sRGB.
Vec3 rampColour(float t) {
  constexpr std::array<Vec3, 4> kStops{Vec3{0.36f, 0.18f, 0.78f}, Vec3{0.86f, 0.25f, 0.55f},
                                       Vec3{1.0f, 0.58f, 0.25f}, Vec3{1.0f, 0.95f, 0.4f}};
  const float at = std::clamp(t, 0.0f, 1.0f) * 3.0f;
  const size_t from = std::min<size_t>(2, static_cast<size_t>(at));
  return kStops[from] + (kStops[from + 1] - kStops[from]) * (at - static_cast<float>(from));
}

// The colour of `value` on a logarithmic scale from `low` to `high`, both above 0, since flux and
// radius span decades.
Vec3 logColour(float value, float low, float high) {
  if (!(value > low)) return rampColour(high > low ? 0.0f : 0.5f);
  return rampColour(high > low ? std::log(value / low) / std::log(high / low) : 0.5f);
}

// The weakest 2 % and the strongest 1 % of the values get the ends of the ramp.
std::vector<Vec3> logColours(const std::vector<float>& values) {
  const float low = percentileOf(values, 0.02), high = percentileOf(values, 0.99);
  std::vector<Vec3> colours;
  colours.reserve(values.size());
  for (const float v : values) colours.push_back(logColour(v, low, high));
  return colours;
}

std::vector<Vec3> radiusColours(const VplTable& table) {
  std::vector<Vec3> colours;
  if (table.radius.empty()) return colours;
  const auto [low, high] = std::minmax_element(table.radius.begin(), table.radius.end());
  for (const float r : table.radius) colours.push_back(logColour(r, *low, *high));
  return colours;
}

std::vector<Vec3> dotColours(const VplTable& table, const PlotOptions& options) {
  const DotColour colour = options.colour;
  if (colour == DotColour::Flux) {
    // The strongest channel counts: dots with the hue of their flux would be lost on walls of it.
    return logColours(strongestFlux(table));
  }
  if (colour == DotColour::Radius) return radiusColours(table);
  if (colour == DotColour::Contribution)
    return logColours({options.contributions.begin(), options.contributions.end()});
  return std::vector<Vec3>(table.size(), kPlainDot);
}

}  // namespace

void requireColours(const fs::path& file, const VplTable& table, DotColour colour) {
  if (colour == DotColour::Flux && table.stage < VplStage::Lit) {
    throw InputError(file, "its rows have no flux to colour by; name a file from " +
                               std::string(stageTools(VplStage::Lit)));
  }
  if (colour == DotColour::Radius && table.stage < VplStage::Eliminated)
    throw InputError(file, "its rows have no radius to colour by; run vpl-eliminate first");
}

Canvas shadeView(const Accelerator& accel, unsigned samplesPerAxis) {
  const Scene& scene = accel.scene();
  Canvas canvas{static_cast<int>(scene.film.width), static_cast<int>(scene.film.height), {}};
  canvas.pixels.resize(size_t{scene.film.width} * scene.film.height);
  const uint64_t key = streamKey(0, RandomStream::Plot);
  const float n = static_cast<float>(samplesPerAxis);
  parallelFor(canvas.pixels.size(), 256, [&](size_t i) {
    const size_t column = i % scene.film.width, row = i / scene.film.width;
    Rng rng(key, i);
    Vec3 sum;
    for (unsigned s = 0; s < samplesPerAxis * samplesPerAxis; ++s) {
      const unsigned sx = s % samplesPerAxis, sy = s / samplesPerAxis;
      const float x = static_cast<float>(column) + (static_cast<float>(sx) + 0.5f) / n;
      const float y = static_cast<float>(row) + (static_cast<float>(sy) + 0.5f) / n;
      const Vec3 direction =
          cameraDirection(scene.camera, scene.film, x / static_cast<float>(scene.film.width),
                          y / static_cast<float>(scene.film.height));
      sum += min(shadeRay(accel, scene.camera.position, direction, rng), Vec3(1.0f));
    }
    canvas.pixels[i] = encoded(sum / (n * n));
  });
  return canvas;
}

std::vector<Dot> visibleDots(const VplTable& table, const Accelerator& accel,
                             const PlotOptions& options, PlotCounts& counts) {
  const std::vector<Vec3> colours = dotColours(table, options);
  const std::vector<RowInView> rows = rowsInView(table, accel);
  const auto width = static_cast<float>(accel.scene().film.width);
  const auto height = static_cast<float>(accel.scene().film.height);
  std::vector<Dot> visible;
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto& [film, sight, _] = rows[i];
    const bool back = sight == RowSight::BackInSight;
    counts.drawn += sight == RowSight::InSight;
    counts.facingAway += sight == RowSight::FacingAway || back;
    counts.occluded += sight == RowSight::Occluded;
    counts.outside += sight == RowSight::Outside;
    if (sight != RowSight::InSight && !(back && options.showBack)) continue;
    visible.push_back({film.x * width, film.y * height, film.depth, colours[i], back});
  }
  return visible;
}

}  // namespace bnvpl
