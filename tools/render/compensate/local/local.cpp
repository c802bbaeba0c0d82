// Local virtual lights (Davidovic, Krivanek, Hasan, Slusallek & Bala 2010): a few receivers of a
// block of pixels shoot rays, whose hits light the whole block without shadow rays with what the
// bound on 1/d^2 takes from VPLs.
#include "tools/render/compensate/local/local_lights.h"
#include "tools/render/tile_dimensions.h"

namespace bnvpl::methods::compensate::local {

namespace {

constexpr auto kBlockOption =
    wholeOption("local-block", "8", 1, kTileSide, "pixels",
                "side of the blocks whose receivers share local lights; 1: each has its own");
constexpr auto kShootersOption = wholeOption("local-shooters", "64", 1, kTileSide* kTileSide, "",
                                             "receivers of a block that shoot rays");
constexpr auto kRaysOption = wholeOption("local-rays", "1", 1, 4096, "",
                                         "BSDF rays from each of them, whose hits become lights");
constexpr auto kRadiusOption =
    realOption("local-radius", "0.5", 0, 100, "",
               "radius of a local light over that of the disk that its ray stands for; a sphere "
               "blurs, a point (0) has spikes");
constexpr auto kOptions = optionTable(kBlockOption, kShootersOption, kRaysOption, kRadiusOption);
constexpr std::array kCounters{
    Counter{"locallights", "local lights", "local virtual lights of the sample's block"}};

struct Blocks {
  const Accelerator& accel;
  UncoveredShare share;
  uint32_t side;
  LocalLightOptions options;

  size_t operator()(const TileReceivers& tile, const VertexLights& lights,
                    std::span<Gathered> out) const;
  size_t light(std::span<const size_t> members, const TileReceivers& tile,
               const VertexLights& lights, uint64_t key, std::span<Gathered> out) const;
};

// Lights the receivers of each block of pixels and sample index together.
size_t Blocks::operator()(const TileReceivers& tile, const VertexLights& lights,
                          std::span<Gathered> out) const {
  if (!(share.clampRadius > 0.0f)) return 0;  // VPLs leave out nothing
  size_t sent = 0;
  const uint32_t across = (tile.width + side - 1) / side, height = tile.pixels / tile.width;
  const uint32_t blocks = across * ((height + side - 1) / side);
  std::vector<std::vector<size_t>> members(blocks);
  for (size_t first = 0; first < out.size(); first += tile.pixels) {
    for (std::vector<size_t>& of : members) of.clear();
    for (uint32_t p = 0; p < tile.pixels; ++p) {
      const uint32_t block = p / tile.width / side * across + p % tile.width / side;
      if (tile.bsdf[first + p]) members[block].push_back(first + p);
    }
    const uint64_t sample = tile.sampleIndex(first);
    for (uint32_t b = 0; b < blocks; ++b) {
      if (members[b].empty()) continue;
      sent += light(members[b], tile, lights, random64(tile.key, sample << 32 | b, kDimLocalLights),
                    out);
    }
  }
  return sent;
}

size_t Blocks::light(std::span<const size_t> members, const TileReceivers& tile,
                     const VertexLights& lights, uint64_t key, std::span<Gathered> out) const {
  std::vector<const Bsdf*> receivers;
  for (const size_t i : members) receivers.push_back(tile.bsdf[i]);
  const LocalLights local(accel, lights, share, options, receivers, key, tile.groups);
  for (size_t k = 0; k < members.size(); ++k) {
    const size_t i = members[k];
    out[i] = local.at(*receivers[k], random64(key, k, 2), tile.groupsOf(i));
    out[i].counts[0] = static_cast<uint32_t>(local.size());
  }
  out[members[0]].shadowRays += static_cast<uint32_t>(local.shadowRays());
  return local.raysSent();
}

Compensation make(const CompensateInputs& in, const Values& options) {
  const float size = in.clamp * commonRadius(in.lit);
  return {
      .lookUp = {},
      .uncovered = {},
      .tile = Blocks{in.accel,
                     {INFINITY, size, in.light},
                     static_cast<uint32_t>(options[kBlockOption]),
                     {static_cast<uint32_t>(options[kShootersOption]),
                      static_cast<uint32_t>(options[kRaysOption]), options.real32(kRadiusOption)}}};
}

}  // namespace

extern const CompensateMethod method{
    .name = "local",
    .summary = "local virtual lights of each block of pixels add what a bound of one size removes",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .oneSize = true,
    .correlatesPixels = true};

}  // namespace bnvpl::methods::compensate::local
