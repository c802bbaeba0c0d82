#include "tools/render/integrator/vpl/vpl_integrator.h"

#include <algorithm>
#include <array>

#include "tools/render/integrator/camera_vertex.h"

namespace bnvpl {

namespace {

// Dimensions of a tile's random numbers, after its gather's. The rays of all samples of a pixel are
// points of one sequence: what they look for is much the same for each of them. It repeats after
// 2^32 points.
constexpr uint32_t kDrawDirection = 16, kDrawLight = 1u << 30, kDrawMore = 5u << 28;
// With a price: rays that tell how many are worth it, and the most, over those asked for.
constexpr unsigned kFirstPart = 4, kMostTimes = 4;

// Of sample i.
uint32_t slotOf(const TileSlots& tile, size_t i) {
  return tile.firstSlot + static_cast<uint32_t>(i / tile.pixels);
}

}  // namespace

// What the samples of a tile have seen.
struct VplIntegrator::Vertices {
  std::vector<SpecularPath> seen;
  std::vector<Bsdf> made;
  std::vector<const Bsdf*> bsdf;  // null: nothing to light
};

double VplIntegrator::render(const TileSamples& tile, const Balance& balance) const {
  // All vertices first, then their VPLs together, then the rest sample by sample.
  const size_t count = tile.samples.size();
  Vertices at{std::vector<SpecularPath>(count), {}, std::vector<const Bsdf*>(count, nullptr)};
  at.made.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    s.radiance = {};
    at.seen[i] = seeFrom(rays_, lights_, s.origin, s.direction, s.rng, s.radiance);
    if (seenLight_ && !directSamples_) {
      s.radiance.direct = seenLight_->withMoreRays(
          s.radiance.direct, 1, tile, static_cast<uint32_t>(i % tile.pixels), slotOf(tile, i));
    }
    if (!at.seen[i].rough) continue;
    at.bsdf[i] = &at.made.emplace_back(rays_.scene(), at.seen[i].hit);
    describeVertex(*at.bsdf[i], s.radiance);
  }
  const LearnedStrata strata = tileLights_ ? tileLights_->at(tile.x, tile.y) : LearnedStrata{};
  const LearnedLight learned{tileLights_ ? &strata : nullptr, lightRays_};
  DirectSamples::Pilot pilot;
  if (directSamples_) pilot = directSamples_->pilot(tile, learned.strata);
  double cost = double(count) * cost::kCameraRay;
  if (only_ != Only::Direct) gatherTile(tile, at, balance, pilot.light);
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    cost += s.radiance.shadowRays + cost::kCluster * s.radiance.cut;
    if (!at.bsdf[i] || only_ == Only::Indirect || directSamples_) continue;
    const uint64_t key = random64(tile.key, i % tile.pixels, kDrawLight);
    s.radiance.direct +=
        at.seen[i].throughput * directAt(*at.bsdf[i], learned, slotOf(tile, i), key, s.rng);
  }
  if (nearFieldRays_ > 0)
    cost += cost::kNearFieldRay * addNearField(tile, at, learned, balance, pilot.light);
  if (pixelControl_) pixelControl_->apply(tile, at.seen);
  for (size_t i = 0; caustics_ && i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    tile.samples[i].radiance.indirect +=
        caustics_->at(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
  }
  cost /= double(count);
  if (directSamples_) cost += directSamples_->render(tile, learned.strata, pilot, cost, balance);
  return cost;
}

Vec3 VplIntegrator::directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t slot,
                             uint64_t key, Rng& rng) const {
  if (!learned.strata) {
    return directLight(rays_, lights_, bsdf, LobeGroup::Rough, LightChoice::Each, nearFieldRays_,
                       rng);
  }
  return directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned, nearFieldRays_,
                     slot * lightRays_, key);
}

void VplIntegrator::gatherTile(const TileSamples& tile, const Vertices& at, const Balance& balance,
                               Vec3 direct) const {
  std::vector<Gathered> gathered(at.bsdf.size());
  TileReceivers receivers{tile, at.bsdf};
  receivers.price = balance.price;
  if (balance.price > 0.0) {
    receivers.otherLight =
        direct.x + direct.y + direct.z + static_cast<float>(std::sqrt(3.0 * balance.light));
  }
  gather_.tile(receivers, gathered);
  for (size_t i = 0; i < gathered.size(); ++i) {
    RadianceSample& out = tile.samples[i].radiance;
    out.indirect += at.seen[i].throughput * gathered[i].radiance;
    out.clamped += at.seen[i].throughput * gathered[i].clamped;
    out.cut += gathered[i].cut;
    out.shadowRays += gathered[i].shadowRays;
  }
}

// Returns how many rays it sent.
double VplIntegrator::addNearField(const TileSamples& tile, const Vertices& at,
                                   const LearnedLight& learned, const Balance& balance,
                                   Vec3 direct) const {
  const size_t count = at.bsdf.size();
  std::vector<RaysBrought> brought(count);
  const auto send = [&](size_t i, unsigned rays, uint64_t key) {
    if (!at.bsdf[i] || rays == 0) return;
    const SpecularPath& seen = at.seen[i];
    nearField_.send(
        {*at.bsdf[i], seen.throughput, learned,
         caustics_ && seen.links == 0 ? caustics_->shared(seen.hit) : SharedWithPhotons{}},
        gather_.point, rays, slotOf(tile, i) * rays, key, tile.samples[i].rng, brought[i]);
  };
  const bool priced = balance.price > 0.0 && only_ != Only::Direct;
  const unsigned first = priced ? (nearFieldRays_ + kFirstPart - 1) / kFirstPart : nearFieldRays_;
  for (size_t i = 0; i < count; ++i)
    send(i, first, random64(tile.key, i % tile.pixels, kDrawDirection));
  if (priced) {
    std::vector<PixelDraws> draws(tile.pixels);
    for (size_t i = 0; i < count; ++i) {
      PixelDraws& pixel = draws[i % tile.pixels];
      if (i < tile.pixels) pixel.light = direct;
      pixel.light += tile.samples[i].radiance.indirect *
                     (static_cast<float>(tile.pixels) / static_cast<float>(count));
      pixel.sum += brought[i].indirect, pixel.squares += brought[i].squares;
      pixel.count += brought[i].rays;
    }
    std::vector<unsigned> worth(tile.pixels);
    for (uint32_t p = 0; p < tile.pixels; ++p)
      worth[p] = worthAround(draws, tile, p, cost::kNearFieldRay, balance, first,
                             kMostTimes * nearFieldRays_);
    for (size_t i = 0; i < count; ++i) {
      const size_t pixel = i % tile.pixels;
      send(i, worth[pixel] - first,
           random64(tile.key, uint64_t{pixel} << 32 | tile.firstSlot, kDrawMore));
    }
  }
  double rays = 0.0;
  for (size_t i = 0; i < count; ++i) {
    brought[i].addMeanTo(tile.samples[i].radiance);
    rays += brought[i].rays;
  }
  return rays;
}

}  // namespace bnvpl
