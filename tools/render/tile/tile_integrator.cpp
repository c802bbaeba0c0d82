#include "tools/render/tile/tile_integrator.h"

#include <algorithm>
#include <array>
#include <bit>

#include "tools/render/integrator/camera_vertex.h"

namespace bnvpl {

namespace {

// Dimensions of a tile's random numbers, after its gather's. The rays of all samples of a pixel are
// points of one sequence: what they look for is much the same for each of them. It repeats after
// 2^32 points.
constexpr uint32_t kDrawDirection = 16, kDrawSeen = 17, kDrawLight = 1u << 30, kDrawMore = 5u << 28,
                   kDrawColours = 11u << 28;
// With a price: rays that tell how many are worth it, and the most, over those asked for.
constexpr unsigned kFirstPart = 4, kMostTimes = 4;
// Of so many slots one tells how much noise shared hits leave.
constexpr size_t kSlotsForOne = 4;

// Of sample i.
uint32_t slotOf(const TileSlots& tile, size_t i) {
  return tile.firstSlot + static_cast<uint32_t>(i / tile.pixels);
}

}  // namespace

// What the samples of a tile have seen.
struct TileIntegrator::Vertices {
  std::vector<SpecularPath> seen;
  std::vector<Bsdf> made;
  std::vector<const Bsdf*> bsdf;  // of `made`; null: nothing to light
  size_t indexOf(size_t sample) const { return static_cast<size_t>(bsdf[sample] - made.data()); }
};

// What a sample gets of shared hits, and what each brings, squared, channels added up.
struct TileIntegrator::SharedLight {
  Vec3 radiance;
  double squares = 0.0;
};

double TileIntegrator::render(const TileSamples& tile, const Balance& balance) const {
  // All vertices first, then their VPLs together, then the rest sample by sample.
  const size_t count = tile.samples.size();
  Vertices at{std::vector<SpecularPath>(count), {}, std::vector<const Bsdf*>(count, nullptr)};
  at.made.reserve(count);
  const LearnedStrata strata = parts_.lights ? parts_.lights->at(tile.x, tile.y) : LearnedStrata{};
  const LearnedLight learned{parts_.lights ? &strata : nullptr, parts_.lightRays};
  const LightsBehind behind{learned.strata, parts_.surfaceLights};
  const bool directAlone = parts_.directSamples && only_ == Only::Direct;
  for (CameraSample& s : tile.samples) s.radiance = {};
  for (size_t i = 0; i < count && !directAlone; ++i) {
    CameraSample& s = tile.samples[i];
    Rng rng = Rng::spread(random64(tile.key, i % tile.pixels, kDrawSeen), slotOf(tile, i));
    at.seen[i] = seeFrom(rays_, lights_, s.origin, s.direction, rng, s.radiance, behind);
    if (parts_.seenLight && !parts_.directSamples) {
      parts_.seenLight->withMoreRays(s.radiance, 1, tile, static_cast<uint32_t>(i % tile.pixels),
                                     slotOf(tile, i), behind);
    }
    if (!at.seen[i].rough) continue;
    at.bsdf[i] = &at.made.emplace_back(rays_.scene(), at.seen[i].hit);
    describeVertex(*at.bsdf[i], s.radiance);
  }
  DirectSamples::Pilot pilot;
  if (parts_.directSamples) pilot = parts_.directSamples->pilot(tile, learned.strata);
  double cost = directAlone ? 0.0 : double(count) * cost::kCameraRay;
  if (parts_.gather && only_ != Only::Direct) gatherTile(tile, at, balance, pilot.light);
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    cost += s.radiance.shadowRays + cost::kCluster * s.radiance.cut;
    if (!at.bsdf[i] || only_ == Only::Indirect || parts_.directSamples) continue;
    const uint64_t key = random64(tile.key, i % tile.pixels, kDrawLight);
    s.radiance.direct +=
        at.seen[i].throughput * directAt(*at.bsdf[i], learned, slotOf(tile, i), key, s.rng);
  }
  if (parts_.rays) cost += addRays(tile, at, learned, balance, pilot.light);
  if (parts_.control) parts_.control(tile, at.seen);
  for (size_t i = 0; parts_.caustics && i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    RadianceSample& out = tile.samples[i].radiance;
    out.photons = parts_.caustics->at(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
    out.indirect += out.photons.all;
  }
  cost /= double(count);
  if (parts_.directSamples)
    cost += parts_.directSamples->render(tile, at.seen, learned.strata, pilot, cost, balance);
  return cost;
}

Vec3 TileIntegrator::directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t slot,
                              uint64_t key, Rng& rng) const {
  if (!learned.strata) {
    return directLight(rays_, lights_, bsdf, LobeGroup::Rough, LightChoice::Each,
                       static_cast<float>(parts_.raysEach), rng);
  }
  const uint32_t first = slot * parts_.lightRays;
  if (!parts_.rays)
    return directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned, 0, first, key);
  const Directions directions = parts_.rays->directionsFrom(bsdf);
  const auto rayPdf = [&](Vec3 wi) {
    return static_cast<float>(parts_.raysEach) * directions.pdf(wi);
  };
  return directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned, rayPdf, first, key);
}

void TileIntegrator::gatherTile(const TileSamples& tile, const Vertices& at, const Balance& balance,
                                Vec3 direct) const {
  std::vector<Gathered> gathered(at.bsdf.size());
  TileReceivers receivers{tile, at.bsdf};
  receivers.price = balance.price;
  if (balance.price > 0.0) {
    receivers.otherLight =
        direct.x + direct.y + direct.z + static_cast<float>(std::sqrt(3.0 * balance.light));
    receivers.filmLight = static_cast<float>(std::sqrt(3.0 * balance.film));
  }
  parts_.gather(receivers, gathered);
  for (size_t i = 0; i < gathered.size(); ++i) {
    RadianceSample& out = tile.samples[i].radiance;
    out.indirect += at.seen[i].throughput * gathered[i].radiance;
    out.clamped += at.seen[i].throughput * gathered[i].clamped;
    out.cut += gathered[i].cut;
    out.shadowRays += gathered[i].shadowRays;
  }
}

// Two colours for the samples of each slot, of as many pixels, and the blocks of pixels that share
// hits. Both are cut anew for each slot, so that they make no pattern in the image: blocks lie at
// random places (around the tile's borders), and the colour is a Walsh function over the bits of
// x and y. It holds the lowest bit of each, so that pixels side by side mostly share nothing: their
// noise differs, and no bars are seen.
class TileIntegrator::Colours {
 public:
  explicit Colours(const TileSamples& tile) : tile_(tile) {
    const auto slots = static_cast<uint32_t>(tile.samples.size() / tile.pixels);
    for (uint32_t s = 0; s < slots; ++s) {
      auto random = random64(tile.key, tile.firstSlot + s, kDrawColours);
      const auto draw = [&](uint32_t count) {
        const auto value = static_cast<uint32_t>(random % count);
        random /= count;
        return value;
      };
      patterns_.push_back({1 | draw(kTileSide / 2) << 1, 1 | draw(kTileSide / 2) << 1,
                           draw(kBlockSide), draw(kBlockSide)});
    }
  }
  // The block of a pixel in the slot of `sample`.
  uint32_t block(size_t sample) const {
    const Place at = placeOf(sample);
    return at.y / kBlockSide * kTileSide + at.x / kBlockSide;
  }
  uint32_t of(size_t sample) const {
    const Place at = placeOf(sample);
    const Pattern& pattern = patterns_[sample / tile_.pixels];
    return static_cast<uint32_t>(std::popcount(at.x & pattern.maskX) +
                                 std::popcount(at.y & pattern.maskY)) &
           1u;
  }

 private:
  struct Pattern {
    uint32_t maskX, maskY, shiftX, shiftY;
  };
  struct Place {
    uint32_t x, y;
  };
  Place placeOf(size_t sample) const {
    const auto pixel = static_cast<uint32_t>(sample % tile_.pixels);
    const Pattern& pattern = patterns_[sample / tile_.pixels];
    return {(pixel % tile_.width + pattern.shiftX) % kTileSide,
            (pixel / tile_.width + pattern.shiftY) % kTileSide};
  }

  const TileSamples& tile_;
  std::vector<Pattern> patterns_;  // of its slots
};

// Rays that samples of each colour are worth, by what the first `rays` of each of the other colour
// tell of the noise of one: what they brought, and in place of their hits, what these bring when
// they are shared, of the slots that were asked.
std::array<unsigned, 2> TileIntegrator::worthOf(const TileSamples& tile, const Colours& colours,
                                                std::span<const RaysBrought> brought,
                                                std::span<const SharedLight> shared, unsigned rays,
                                                Vec3 direct, const Balance& balance) const {
  const size_t count = brought.size(), slots = count / tile.pixels;
  const size_t asked = (slots + kSlotsForOne - 1) / kSlotsForOne;
  // A sample's light is the mean of its rays'.
  const double ofHits = double(slots) / double(asked) * rays * rays;
  struct Draws {
    Vec3 light;
    double samples = 0.0, squares = 0.0, rays = 0.0;
  };
  std::array<Draws, 2> draws;
  for (size_t i = 0; i < count; ++i) {
    Draws& of = draws[colours.of(i)];
    const RaysBrought& b = brought[i];
    of.light += tile.samples[i].radiance.indirect;
    if (b.rays > 0) of.light += b.indirect * (1.0f / static_cast<float>(b.rays));
    of.samples += 1.0;
    of.squares += b.squares + ofHits * shared[i].squares;
    of.rays += b.rays;
  }
  const double costOfOne = parts_.rays->costOfRay() + cost::kSharedHit * (parts_.sharers - 1);
  std::array<unsigned, 2> worth{rays, rays};
  for (const size_t colour : {0u, 1u}) {
    const Draws& others = draws[1 - colour];
    if (!(others.rays > 0.0)) continue;
    const Vec3 light = direct + others.light * static_cast<float>(1.0 / others.samples);
    worth[colour] = drawsWorth(balance.over(others.squares / others.rays, light), costOfOne,
                               balance.price, rays, kMostTimes * parts_.raysEach);
  }
  return worth;
}

// Returns its cost.
double TileIntegrator::addRays(const TileSamples& tile, const Vertices& at,
                               const LearnedLight& learned, const Balance& balance,
                               Vec3 direct) const {
  const size_t count = at.bsdf.size();
  const Colours colours(tile);
  std::vector<RaysBrought> brought(count);
  // As at.made.
  std::vector<Directions> directions;
  directions.reserve(at.made.size());
  for (const Bsdf& bsdf : at.made) directions.push_back(parts_.rays->directionsFrom(bsdf));
  const double costOfRay = parts_.rays->costOfRay();
  const auto send = [&](size_t i, unsigned rays, uint64_t key) {
    if (!at.bsdf[i] || rays == 0) return;
    const SpecularPath& seen = at.seen[i];
    parts_.rays->send({directions[at.indexOf(i)], seen.throughput, learned,
                       parts_.caustics && seen.links == 0 ? parts_.caustics->shared(seen.hit)
                                                          : SharedWithPhotons{},
                       parts_.sharers > 1},
                      rays, slotOf(tile, i) * rays, key, brought[i]);
  };
  const bool priced = balance.price > 0.0 && only_ != Only::Direct;
  const unsigned first = priced ? (parts_.raysEach + kFirstPart - 1) / kFirstPart : parts_.raysEach;
  for (size_t i = 0; i < count; ++i)
    send(i, first, random64(tile.key, i % tile.pixels, kDrawDirection));
  std::vector<SharedLight> shared(count);
  double spent = 0.0;
  if (priced) {
    spent += cost::kSharedHit *
             double(share(tile, at, directions, colours, brought, kSlotsForOne, shared));
    const auto worth = worthOf(tile, colours, brought, shared, first, direct, balance);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t colour = colours.of(i);
      send(
          i, worth[colour] - first,
          random64(tile.key, uint64_t{i % tile.pixels} << 32 | tile.firstSlot, kDrawMore + colour));
    }
  }
  spent += cost::kSharedHit * double(share(tile, at, directions, colours, brought, 1, shared));
  for (size_t i = 0; i < count; ++i) {
    brought[i].addMeanTo(tile.samples[i].radiance, shared[i].radiance);
    spent += costOfRay * brought[i].rays;
  }
  return spent;
}

// The light of shared hits, for each sample of one slot in `everySlot` by the rays of its group:
// those of its slot whose pixels lie together and have one colour. What decides on their rays is
// the other colour's (worthOf). Returns the number of shadow rays.
size_t TileIntegrator::share(const TileSamples& tile, const Vertices& at,
                             std::span<const Directions> directions, const Colours& colours,
                             std::span<const RaysBrought> brought, size_t everySlot,
                             std::span<SharedLight> out) const {
  if (parts_.sharers < 2) return 0;
  size_t rays = 0;
  std::vector<size_t> members;
  std::vector<HitSharer> group;
  for (size_t slot = 0; slot < brought.size(); slot += everySlot * tile.pixels) {
    for (const uint32_t colour : {0u, 1u}) {
      members.clear();
      for (size_t i = slot; i < slot + tile.pixels; ++i)
        if (at.bsdf[i] && colours.of(i) == colour) members.push_back(i);
      std::ranges::stable_sort(members, {}, [&](size_t i) { return colours.block(i); });
      for (size_t begin = 0; begin < members.size(); begin += parts_.sharers) {
        const std::span<const size_t> some = std::span(members).subspan(
            begin, std::min<size_t>(parts_.sharers, members.size() - begin));
        group.clear();
        for (const size_t i : some)
          group.push_back({&directions[at.indexOf(i)], brought[i].rays, brought[i].hits});
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
