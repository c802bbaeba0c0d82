// Gathers all samples of a tile with one cut of the light tree: the clusters are chosen once for
// the tile, and each packet of samples takes one random VPL of each. Cuts are shared as in
// LightSlice (Ou & Pellacini 2011), and representatives are random as in Stochastic Lightcuts
// (Yuksel 2019). The estimate is unbiased.

#include <algorithm>
#include <array>
#include <vector>

#include "tools/render/gather/tilecuts/receiver_packet.h"
#include "tools/render/gather/tilecuts/shadow_queue.h"
#include "tools/render/gather/tilecuts/tile_cut.h"
#include "tools/render/light_tree/cluster_deviation.h"

namespace bnvpl::methods::gather::tilecuts {

namespace {

// The predicted error is two and a half to five times the measured one (theory.md).
constexpr auto kErrorOption =
    inTopic(Topic::Quality, realOption("error", "0.05", 0, 1, "share of the tile's light",
                                       "allowed standard deviation of a pixel"));
constexpr auto kOptions = optionTable(kErrorOption, kMaxCutOption);

// Index of a pixel's packet. The pixels of each 2 x 2 belong to four different packets.
uint32_t packetOfPixel(uint32_t x, uint32_t y, uint64_t tileKey) {
  const auto permutation =
      static_cast<uint32_t>(random64(tileKey, y / 2 << 16 | x / 2, kDimPacket) % 4);
  return (y % 2 << 1 | x % 2) ^ permutation;
}

// Index of a pixel in an order in which the pixels of each 2 x 2 are consecutive.
uint32_t orderOfPixel(uint32_t x, uint32_t y, uint32_t width) {
  return (y / 2 * ((width + 1) / 2) + x / 2) << 2 | y % 2 << 1 | x % 2;
}

// A packet takes a random pixel of each 2 x 2 in 8 x 8 pixels, as far as they have receivers.
// Pixels of a packet share their error. Spread in this way the error is fine grain, while packets
// of 4 x 4 neighbours would be visible as blocks. Draws from a cluster are stratified over all
// packets of the tile and over the samples of each pixel, which are all in the same packet.
std::vector<ReceiverPacket> makePackets(const Accelerator& accel, const TileReceivers& tile) {
  std::vector<uint32_t> packetOf;  // one per pixel
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    packetOf.push_back(packetOfPixel(p % tile.width, p / tile.width, tile.key));
  }
  const auto perPixel = static_cast<uint32_t>(tile.bsdf.size() / tile.pixels);
  constexpr uint32_t kSize = ReceiverPacket::kSize;
  std::vector<ReceiverPacket> packets;
  packets.reserve(size_t{perPixel} * ((tile.pixels + kSize - 1) / kSize));
  std::vector<uint32_t> receivers;  // those of one sample index
  for (uint32_t sample = 0; sample < perPixel; ++sample) {
    receivers.clear();
    for (uint32_t p = 0; p < tile.pixels; ++p) {
      if (tile.bsdf[size_t{sample} * tile.pixels + p])
        receivers.push_back(sample * tile.pixels + p);
    }
    std::stable_sort(receivers.begin(), receivers.end(), [&](uint32_t a, uint32_t b) {
      return packetOf[a % tile.pixels] < packetOf[b % tile.pixels];
    });
    const size_t packetsHere = (receivers.size() + kSize - 1) / kSize;
    const uint32_t sampleOfPixel = tile.firstSample + sample;
    for (size_t number = 0; number < packetsHere; ++number) {
      ReceiverPacket& packet = packets.emplace_back();
      if (tile.groupSums) packet.groups.resize(tile.groups);
      packet.stratumOffset =
          (static_cast<float>(sampleOfPixel) +
           (static_cast<float>(number) + 0.5f) / static_cast<float>(packetsHere)) /
          static_cast<float>(tile.samplesPerPixel);
      packet.rouletteKey = mix64(tile.key + sampleOfPixel);
      packet.rouletteDraw = kDimRoulette + static_cast<uint32_t>(number);
      const size_t begin = number * receivers.size() / packetsHere,
                   end = (number + 1) * receivers.size() / packetsHere;
      for (size_t k = begin; k < end; ++k) {
        const uint32_t pixel = receivers[k] % tile.pixels;
        const Bsdf& b = *tile.bsdf[receivers[k]];
        packet.add(receivers[k], b, accel.offsetOrigin(b.point().position, b.point().ng),
                   orderOfPixel(pixel % tile.width, pixel / tile.width, tile.width));
      }
    }
  }
  return packets;
}

template <typename Kind>
bool exceedsAnywhere(const LightNode& n, float allowed, const ReceiverPacket& p) {
  const DeviationModel<Kind> expected(n);
  int exceeds = 0;
  for (uint32_t l = 0; l < ReceiverPacket::kSize; ++l) {
    exceeds |= expected
                   .at({p.x[l], p.y[l], p.z[l]}, {p.sx[l], p.sy[l], p.sz[l]},
                       {p.maxReflectedRed[l], p.maxReflectedGreen[l], p.maxReflectedBlue[l]})
                   .exceeds(allowed);
  }
  return exceeds != 0;
}
// Whether a cluster of the tile's cut must be refined for a packet, because it is much nearer to
// one of its receivers than to the sample receivers: its deviation alone would exceed the allowed
// one.
bool tooNear(const LightNode& n, float allowed, const ReceiverPacket& p) {
  if (n.leaf() || surelyFaint(n, allowed, p.bounds, p.brightest)) return false;
  return withKind(n.kind,
                  [&](auto kind) { return exceedsAnywhere<decltype(kind)>(n, allowed, p); });
}

void gatherTile(const Accelerator& accel, const VplLights& vpls, const LightTree& tree,
                const TileCutOptions& options, const TileReceivers& tile, std::span<Gathered> out) {
  std::fill(out.begin(), out.end(), Gathered{});
  if (tree.nodes.empty()) return;
  const TileCut cut = chooseTileCut(accel, vpls, tree, options, tile);
  if (cut.nodes.empty()) return;
  std::vector<ReceiverPacket> packets = makePackets(accel, tile);
  ShadowQueue queue(accel, vpls, packets);
  Bounds bounds;
  float brightest = 0.0f;
  for (const ReceiverPacket& packet : packets) {
    bounds.extend(packet.bounds);
    brightest = std::max(brightest, packet.brightest);
  }
  const auto take = [&](uint32_t node, ReceiverPacket& packet) {
    const float u = packet.stratumOffset + toUnitFloat(random64(tile.key, node, kDimStratum));
    queue.add(packet, tree.draw(tree.nodes[node], u < 1.0f ? u : u - 1.0f), node, cut.negligible);
    ++packet.clusters;
  };
  std::vector<uint32_t> open;
  // Handles all samples cluster by cluster, so that rays to the same cluster are traced together.
  for (const uint32_t ofCut : cut.nodes) {
    const bool faint = surelyFaint(tree.nodes[ofCut], cut.allowedDeviation, bounds, brightest);
    for (ReceiverPacket& packet : packets) {
      if (faint) {
        take(ofCut, packet);
        continue;
      }
      open.assign(1, ofCut);
      while (!open.empty()) {
        const uint32_t node = open.back();
        open.pop_back();
        if (tooNear(tree.nodes[node], cut.allowedDeviation, packet)) {
          open.push_back(tree.nodes[node].right);
          open.push_back(tree.nodes[node].left);
        } else {
          take(node, packet);
        }
      }
    }
  }
  queue.flush();
  for (const ReceiverPacket& packet : packets) packet.writeTo(tile, out);
}

Gather make(const GatherInputs& in, const Values& values) {
  const TileCutOptions options{values.real32(kErrorOption),
                               static_cast<uint32_t>(values[kMaxCutOption])};
  return {[&accel = in.accel, &vpls = in.vpls, &tree = in.tree, options](const TileReceivers& tile,
                                                                         std::span<Gathered> out) {
    gatherTile(accel, vpls, tree, options, tile, out);
  }};
}

}  // namespace

extern const GatherMethod method{
    "tilecuts", "a cut for each tile, a random VPL per cluster for each sample", kOptions, make};

}  // namespace bnvpl::methods::gather::tilecuts
