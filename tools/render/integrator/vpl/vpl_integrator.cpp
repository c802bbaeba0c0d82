#include "tools/render/integrator/vpl/vpl_integrator.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "tools/render/integrator/camera_vertex.h"

namespace bnvpl {

namespace {

// Dimensions of a tile's random numbers, after its gather's. The rays of all samples of a pixel are
// points of one sequence: what they look for is much the same for each of them. It repeats after
// 2^32 points.
constexpr uint32_t kDrawDirection = 16, kDrawLight = 1u << 30, kDrawMore = 5u << 28;
// With a price: rays that tell how many are worth it, and the most, over those asked for.
constexpr unsigned kFirstPart = 4, kMostTimes = 4;
// Of so many slots one tells how much noise shared hits leave.
constexpr size_t kSlotsForOne = 4;
// Pixels on a side: those of a block, which see much the same, share hits first.
constexpr uint32_t kBlock = 4;

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

// What a sample gets of shared hits, and what each brings, squared, channels added up.
struct VplIntegrator::SharedLight {
  Vec3 radiance;
  double squares = 0.0;
};

double VplIntegrator::render(const TileSamples& tile, const Balance& balance) const {
  // All vertices first, then their VPLs together, then the rest sample by sample.
  const size_t count = tile.samples.size();
  Vertices at{std::vector<SpecularPath>(count), {}, std::vector<const Bsdf*>(count, nullptr)};
  at.made.reserve(count);
  const LearnedStrata strata = tileLights_ ? tileLights_->at(tile.x, tile.y) : LearnedStrata{};
  const LearnedLight learned{tileLights_ ? &strata : nullptr, lightRays_};
  const LightsBehind behind{learned.strata, surfaceLights_};
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    s.radiance = {};
    at.seen[i] = seeFrom(rays_, lights_, s.origin, s.direction, s.rng, s.radiance, behind);
    if (seenLight_ && !directSamples_) {
      seenLight_->withMoreRays(s.radiance, 1, tile, static_cast<uint32_t>(i % tile.pixels),
                               slotOf(tile, i), behind);
    }
    if (!at.seen[i].rough) continue;
    at.bsdf[i] = &at.made.emplace_back(rays_.scene(), at.seen[i].hit);
    describeVertex(*at.bsdf[i], s.radiance);
  }
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
  if (nearFieldRays_ > 0) cost += addNearField(tile, at, learned, balance, pilot.light);
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

// What the first `rays` near-field rays of each sample tell of the noise of one: what they brought,
// and in place of their hits, what these bring when they are shared, of the slots that were asked.
std::vector<PixelDraws> VplIntegrator::drawsOf(const TileSamples& tile,
                                               std::span<const RaysBrought> brought,
                                               std::span<const SharedLight> shared, unsigned rays,
                                               Vec3 direct) {
  const size_t count = brought.size(), slots = count / tile.pixels;
  const float each = 1.0f / static_cast<float>(slots);
  const size_t asked = (slots + kSlotsForOne - 1) / kSlotsForOne;
  // A sample's light is the mean of its rays'.
  const double ofHits = double(slots) / double(asked) * rays * rays;
  std::vector<PixelDraws> draws(tile.pixels);
  for (size_t i = 0; i < count; ++i) {
    PixelDraws& pixel = draws[i % tile.pixels];
    const RaysBrought& b = brought[i];
    if (i < tile.pixels) pixel.light = direct;
    pixel.light += tile.samples[i].radiance.indirect * each;
    if (b.rays > 0) pixel.light += b.indirect * (each / static_cast<float>(b.rays));
    pixel.squares += b.squares + ofHits * shared[i].squares;
    pixel.count += b.rays;
  }
  return draws;
}

// Returns its cost.
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
         caustics_ && seen.links == 0 ? caustics_->shared(seen.hit) : SharedWithPhotons{},
         sharers_ > 1},
        gather_.point, rays, slotOf(tile, i) * rays, key, tile.samples[i].rng, brought[i]);
  };
  const bool priced = balance.price > 0.0 && only_ != Only::Direct;
  const unsigned first = priced ? (nearFieldRays_ + kFirstPart - 1) / kFirstPart : nearFieldRays_;
  for (size_t i = 0; i < count; ++i)
    send(i, first, random64(tile.key, i % tile.pixels, kDrawDirection));
  std::vector<SharedLight> shared(count);
  double spent = 0.0;
  if (priced) {
    spent += cost::kSharedHit * double(share(tile, at, brought, kSlotsForOne, shared));
    const std::vector<PixelDraws> draws = drawsOf(tile, brought, shared, first, direct);
    const double costOfOne = cost::kNearFieldRay + cost::kSharedHit * (sharers_ - 1);
    const auto worth =
        worthByColour(draws, tile, costOfOne, balance, first, kMostTimes * nearFieldRays_);
    for (size_t i = 0; i < count; ++i) {
      const auto pixel = static_cast<uint32_t>(i % tile.pixels);
      send(i, worth[chequer(pixel % tile.width, pixel / tile.width)] - first,
           random64(tile.key, uint64_t{pixel} << 32 | tile.firstSlot, kDrawMore));
    }
  }
  spent += cost::kSharedHit * double(share(tile, at, brought, 1, shared));
  for (size_t i = 0; i < count; ++i) {
    brought[i].addMeanTo(tile.samples[i].radiance, shared[i].radiance);
    spent += cost::kNearFieldRay * brought[i].rays;
  }
  return spent;
}

// The light of shared hits, for each sample of one slot in `everySlot` by the rays of its group:
// those of its slot whose pixels lie together and have one colour. What decides on their rays is
// the other colour's (worthByColour). Returns the number of shadow rays.
size_t VplIntegrator::share(const TileSamples& tile, const Vertices& at,
                            std::span<const RaysBrought> brought, size_t everySlot,
                            std::span<SharedLight> out) const {
  if (sharers_ < 2) return 0;
  size_t rays = 0;
  std::vector<size_t> members;
  std::vector<HitSharer> group;
  std::vector<uint32_t> byBlocks(tile.pixels);
  std::iota(byBlocks.begin(), byBlocks.end(), 0u);
  std::ranges::stable_sort(byBlocks, {}, [&](uint32_t p) {
    return p / tile.width / kBlock * kTileSide + p % tile.width / kBlock;
  });
  for (size_t slot = 0; slot < brought.size(); slot += everySlot * tile.pixels) {
    for (const uint32_t colour : {0u, 1u}) {
      members.clear();
      for (const uint32_t p : byBlocks) {
        if (at.bsdf[slot + p] && chequer(p % tile.width, p / tile.width) == colour)
          members.push_back(slot + p);
      }
      for (size_t begin = 0; begin < members.size(); begin += sharers_) {
        const std::span<const size_t> some =
            std::span(members).subspan(begin, std::min<size_t>(sharers_, members.size() - begin));
        group.clear();
        for (const size_t i : some) group.push_back({at.bsdf[i], brought[i].rays, brought[i].hits});
        rays += shareHits(rays_, group);
        for (size_t k = 0; k < some.size(); ++k) {
          const Vec3 throughput = at.seen[some[k]].throughput;
          out[some[k]] = {throughput * group[k].brought,
                          double{dot(throughput * throughput, group[k].squares)}};
        }
      }
    }
  }
  return rays;
}

}  // namespace bnvpl
