#include "tools/render/integrator/guided/guide.h"

#include <array>

#include "core/cdf.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/random_streams.h"
#include "spatial/packed_disks.h"
#include "transport/specular_path.h"

namespace bnvpl {

namespace {

// Limits of the strata along each side. Below the minimum the guide is empty, as it would be too
// noisy.
constexpr uint32_t kMinSide = 4, kMaxSide = 32;
// Cells per stratum along each side. They are finer than the rays of one VPL, as those of its
// neighbours fill them, too.
constexpr uint32_t kFiner = 2;
// Radius over which the rays of VPLs are averaged, in units of a VPL's radius.
constexpr float kSmooth = 2.5f;
// Points of a VPL's region from which its rays start.
constexpr uint32_t kOrigins = 8;
// A ray's result, and its share of two tables of kFiner² cells a stratum, one made of the other.
constexpr double kBytesPerRay = 40.0;
// Lower bound of the albedo. Incident light that is inferred from darker VPLs is mostly noise.
constexpr float kMinAlbedo = 0.01f;

uint32_t sideOf(uint64_t raysEach) {
  auto side = static_cast<uint32_t>(std::sqrt(static_cast<double>(raysEach)));
  side = std::min(side, kMaxSide);
  return side < kMinSide ? 0 : side;
}

}  // namespace

Guide::Guide(const VplTable& lit, const Accelerator& accel, const LightSet& lights, uint64_t seed,
             uint64_t raysEach, const ProgressFn& progress)
    : position_(lit.position),
      normal_(lit.normal),
      strata_{sideOf(raysEach)},
      grid_{kFiner * strata_.side} {
  if (lit.size() == 0 || strata_.side == 0) return;
  const uint32_t each = strata_.cells();
  requireMemory(kBytesPerRay * double(lit.size()) * double(each), "what guides learn",
                "lower --guide-rays, or keep fewer VPLs with vpl-eliminate -n");
  const NearSurfaces near(position_, normal_, lit.radius, kSmooth);
  findRadiance(lit, near);
  regions_ = RegionGrid(position_, normal_, lit.radius);
  const ProgressFn::Phase phase = progress.beginPhase("guiding distributions", lit.size());
  const uint64_t key = streamKey(seed, RandomStream::Guide);
  std::vector<IncidentSample> samples(lit.size() * each);
  parallelFor(lit.size(), 16, [&](size_t i) {
    learn(accel, lights, key, static_cast<uint32_t>(i), lit.radius[i],
          std::span(samples).subspan(i * each, each));
    if (progress) progress(1);
  });
  fillCdfs(smooth(near, samples));
}

// Exitance over pi around each VPL. It is averaged over the VPLs near it, as one alone may have few
// photons.
void Guide::findRadiance(const VplTable& lit, const NearSurfaces& near) {
  radiance_.resize(lit.size());
  total_.resize(lit.size());
  parallelFor(lit.size(), 64, [&](size_t i) {
    Vec3 flux;
    float area = 0.0f, albedo = 0.0f;
    near.forEach(i, [&](uint32_t k) {
      const float share = packedDiskArea(lit.radius[k]);
      flux += lit.flux[k];
      area += share;
      albedo += share * mean(lit.albedo[k]);
    });
    radiance_[i] = flux * (1.0f / (kPi * area));
    total_[i] = mean(radiance_[i]) / std::max(kMinAlbedo, albedo / area);
  });
}

// Estimates the incident light of each stratum by one ray: emission times its MIS weight against
// light sampling, and the radiance that leaves the VPLs.
void Guide::learn(const Accelerator& accel, const LightSet& lights, uint64_t key, uint32_t region,
                  float radius, std::span<IncidentSample> samples) const {
  Rng rng(key, region);
  const Frame frame(normal_[region]);
  const Vec3 centre = accel.offsetOrigin(position_[region], normal_[region]);
  std::array<Vec3, kOrigins> origins;
  origins.fill(centre);
  for (uint32_t k = 1; k < kOrigins; ++k) {
    const float u = rng.next(), v = rng.next();
    const Vec3 at = centre + frame.toWorld(sampleDisk(u, v)) * radius;
    if (!accel.occluded(centre, at)) origins[k] = at;
  }
  for (uint32_t k = 0; k < strata_.cells(); ++k) {
    const Vec3 from = origins[(k + k / strata_.side) % kOrigins];
    const float u = rng.next(), v = rng.next();
    const Vec3 local = strata_.direction(k, u, v);
    const Vec3 towards = frame.toWorld(local);
    const SpecularPath path =
        followSpecularPath(accel, lights, from, towards, {pdfCosineHemisphere(local.z), from}, rng);
    Vec3 found = path.firstSegmentEmission + path.lightOverSpecular;
    if (path.rough) {
      const uint32_t at = regionAt(path.hit);
      if (at != kNone) {
        found += path.throughput * radiance_[at];
      } else {
        const Bsdf bsdf(accel.scene(), path.hit);
        found += path.throughput *
                 directLight(accel, lights, Reflected{bsdf}, {}, NoRays{}, LightNumbers(rng));
      }
    }
    const float value = mean(found);
    samples[k] = {std::isfinite(value) ? value : 0.0f, grid_.cellOf(local)};
  }
}

// Means of each cell over the rays of neighbouring regions. The mean of the cell's stratum counts
// as one more ray.
std::vector<float> Guide::smooth(const NearSurfaces& near,
                                 std::span<const IncidentSample> samples) const {
  const uint32_t cells = grid_.cells(), each = strata_.cells();
  struct Mean {
    float sum = 0.0f, count = 0.0f;
    void add(const Mean& m) { sum += m.sum, count += m.count; }
    float value() const { return count > 0.0f ? sum / count : 0.0f; }
  };
  std::vector<float> out(position_.size() * cells);
  parallelFor(position_.size(), 16, [&](size_t i) {
    std::vector<Mean> means(cells), strata(each);
    const Frame frame(normal_[i]);
    near.forEach(i, [&](uint32_t k) {
      const Frame other(normal_[k]);
      for (const IncidentSample& l : samples.subspan(size_t{k} * each, each)) {
        uint32_t cell = l.cell;
        if (normal_[k] != normal_[i]) {
          const Vec3 local = frame.toLocal(other.toWorld(grid_.direction(cell, 0.5f, 0.5f)));
          if (local.z <= 0.0f) continue;
          cell = grid_.cellOf(local);
        }
        means[cell].add({l.radiance, 1.0f});
      }
    });
    const auto stratum = [&](uint32_t cell) -> Mean& {
      const uint32_t x = cell % grid_.side / kFiner, y = cell / grid_.side / kFiner;
      return strata[y * strata_.side + x];
    };
    for (uint32_t cell = 0; cell < cells; ++cell) stratum(cell).add(means[cell]);
    for (uint32_t cell = 0; cell < cells; ++cell) {
      means[cell].add({stratum(cell).value(), 1.0f});
      out[i * cells + cell] = means[cell].value();
    }
  });
  return out;
}

void Guide::fillCdfs(const std::vector<float>& radiance) {
  const uint32_t cells = grid_.cells();
  cdf_.resize(radiance.size());
  onward_.resize(position_.size());
  parallelFor(position_.size(), 64, [&](size_t i) {
    const std::vector<double> weights(&radiance[i * cells], &radiance[i * cells] + cells);
    double sum = 0.0;
    for (const double w : weights) sum += w;
    onward_[i] = static_cast<float>(sum / cells);
    const std::vector<float> running = makeCdf<float>(weights);
    std::copy(running.begin(), running.end(), &cdf_[i * cells]);
  });
}

Vec3 Guide::sample(uint32_t region, Point2 at, float& pdf) const {
  const auto cell = static_cast<uint32_t>(sampleCdf(cdf(region), at.x));
  const Vec3 local = grid_.direction(cell, at.x, at.y);
  pdf = cdfProbability(cdf(region), cell) * grid_.pdfInCell(local.z);
  return Frame(normal_[region]).toWorld(local);
}

float Guide::pdf(uint32_t region, Vec3 wi) const {
  const Vec3 local = Frame(normal_[region]).toLocal(wi);
  if (local.z <= 0.0f) return 0.0f;
  return cdfProbability(cdf(region), grid_.cellOf(local)) * grid_.pdfInCell(local.z);
}

}  // namespace bnvpl
