#include "tools/render/tile_gather.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "tools/render/cluster_bounds.h"

namespace bnvpl {

namespace {

// Pixels along the side of a square that four packets share.
constexpr uint32_t kSquare = 8;
// A single draw may be this many times the deviation that is allowed to a sample.
constexpr float kMostDraw = 4.0f;

// Packets in the order of their squares; the pixels of a 2 x 2 are of four different ones.
uint32_t packetOfPixel(uint32_t x, uint32_t y, uint64_t tileKey) {
  const uint32_t square = y / kSquare << 16 | x / kSquare;
  const auto turn = static_cast<uint32_t>(random64(tileKey, y / 2 << 16 | x / 2, kDrawPacket) % 4);
  return square << 2 | ((y % 2 << 1 | x % 2) ^ turn);
}

}  // namespace

// Sixteen receivers that are lit together, and their sums.
struct TileGatherer::Packet {
  static constexpr uint32_t kSize = RayPacket::kSize;
  using Lanes = std::array<float, kSize>;

  RayPacket from;                                                       // lifted positions
  alignas(64) Lanes x{}, y{}, z{}, sx{}, sy{}, sz{}, gx{}, gy{}, gz{};  // point; ns; ng
  alignas(64) Lanes red{}, green{}, blue{};                             // irradiance, W/m2
  alignas(64) Lanes clampedRed{}, clampedGreen{}, clampedBlue{};
  std::array<Vec3, kSize> glossy{}, glossyClamped{};  // radiance, of receivers with a lobe
  std::array<const Bsdf*, kSize> bsdf{};
  std::array<uint32_t, kSize> shadowRays{};
  uint32_t used = 0, lobes = 0;  // masks of lanes
  Bounds bounds;                 // of the points
  float brightest = 0.0f;        // value of any receiver in any channel, 1/sr

  void set(uint32_t lane, const Bsdf& b, Vec3 lifted) {
    const SurfacePoint& p = b.point();
    bsdf[lane] = &b;
    from.set(lane, lifted);
    x[lane] = p.position.x, y[lane] = p.position.y, z[lane] = p.position.z;
    sx[lane] = p.ns.x, sy[lane] = p.ns.y, sz[lane] = p.ns.z;
    gx[lane] = p.ng.x, gy[lane] = p.ng.y, gz[lane] = p.ng.z;
    bounds.extend(p.position);
    brightest =
        std::max(brightest, maxComponent(b.roughUpperBound(1.0f, [](Vec3) { return 1.0f; })));
    used |= 1u << lane;
    if (!b.diffuseOnly()) lobes |= 1u << lane;
  }
};

void TileGatherer::gather(const TileReceivers& tile, std::span<Gathered> out) const {
  std::fill(out.begin(), out.end(), Gathered{});
  if (tree_.nodes.empty()) return;
  const TileCut cut = chooseTileCut(rays_, vpls_, tree_, options_, tile);
  if (cut.nodes.empty()) return;
  const auto slots = static_cast<uint32_t>(tile.bsdf.size() / tile.pixels);
  std::vector<uint32_t> packetOf;  // pixel
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    packetOf.push_back(packetOfPixel(p % tile.width, p / tile.width, tile.key));
  }
  for (uint32_t slot = 0; slot < slots; ++slot) gatherSlot(tile, slot, packetOf, cut, out);
}

// A packet takes a random pixel of each 2 x 2, of 8 x 8 pixels as far as they have receivers. Its
// pixels share their error: dealt out so, it is fine grain, where packets of 4 x 4 neighbours show
// as blocks. Over all packets of the tile the draws from a cluster are stratified, and over the
// slots of one pixel too, which therefore stays in its packet.
void TileGatherer::gatherSlot(const TileReceivers& tile, uint32_t slot,
                              std::span<const uint32_t> packetOf, const TileCut& cut,
                              std::span<Gathered> out) const {
  const uint32_t imageSlot = tile.firstSlot + slot;
  const uint64_t slotKey = mix64(tile.key + imageSlot);
  std::vector<uint32_t> lit;
  for (uint32_t p = 0; p < tile.pixels; ++p) {
    if (tile.bsdf[size_t{slot} * tile.pixels + p]) lit.push_back(slot * tile.pixels + p);
  }
  std::stable_sort(lit.begin(), lit.end(), [&](uint32_t a, uint32_t b) {
    return packetOf[a % tile.pixels] < packetOf[b % tile.pixels];
  });
  const size_t packets = (lit.size() + Packet::kSize - 1) / Packet::kSize;
  for (size_t number = 0; number < packets; ++number) {
    const size_t begin = number * lit.size() / packets, end = (number + 1) * lit.size() / packets;
    Packet packet;
    for (size_t k = begin; k < end; ++k) {
      const Bsdf& b = *tile.bsdf[lit[k]];
      packet.set(static_cast<uint32_t>(k - begin), b,
                 rays_.lifted(b.point().position, b.point().ng));
    }
    const float stratum = (static_cast<float>(imageSlot) +
                           (static_cast<float>(number) + 0.5f) / static_cast<float>(packets)) /
                          static_cast<float>(tile.allSlots);
    uint32_t clusters = 0;
    std::vector<uint32_t> open;
    for (const uint32_t ofCut : cut.nodes) {
      open.assign(1, ofCut);
      while (!open.empty()) {
        const uint32_t node = open.back();
        open.pop_back();
        const LightNode& n = tree_.nodes[node];
        if (tooNear(n, cut.allowed, packet)) {
          open.push_back(n.right);
          open.push_back(n.left);
          continue;
        }
        const float u = stratum + toUnitFloat(random64(tile.key, node, kDrawShift));
        const float roulette =
            toUnitFloat(random64(slotKey, node, kDrawRoulette + uint32_t(number)));
        addCluster(n, u < 1.0f ? u : u - 1.0f, roulette, cut.negligible, packet);
        ++clusters;
      }
    }
    for (size_t k = begin; k < end; ++k) {
      const auto lane = static_cast<uint32_t>(k - begin);
      Gathered& g = out[lit[k]];
      const Vec3 value = packet.bsdf[lane]->diffuseValue();
      g.radiance = value * Vec3(packet.red[lane], packet.green[lane], packet.blue[lane]) +
                   packet.glossy[lane];
      g.clamped = value * Vec3(packet.clampedRed[lane], packet.clampedGreen[lane],
                               packet.clampedBlue[lane]) +
                  packet.glossyClamped[lane];
      g.cut = clusters;
      g.shadowRays = packet.shadowRays[lane];
    }
  }
}

// Whether a cluster of the tile's cut must be opened for a packet, because it is much nearer to one
// of its receivers than the probes knew: it alone would deviate by all that is allowed.
bool TileGatherer::tooNear(const LightNode& n, float allowed, const Packet& p) const {
  if (n.leaf()) return false;
  // First for all at once and without cosines, which rules out nearly all.
  const float light = (n.intensity.x + n.intensity.y + n.intensity.z) * (1.0f / kPi);
  const Vec3 gap =
      max(max(n.bounds.lower - p.bounds.upper, p.bounds.lower - n.bounds.upper), Vec3{});
  if (light * falloff(lengthSquared(gap), n.clamp2) <= allowed) return false;
  for (uint32_t rest = p.used; rest != 0; rest &= rest - 1) {
    const auto l = static_cast<uint32_t>(std::countr_zero(rest));
    const float d2 = n.bounds.distanceSquared(p.bsdf[l]->point().position);
    if (light * falloff(d2, n.clamp2) <= allowed) continue;
    const ExpectedLight e = expectedLight(n, *p.bsdf[l]);
    if (e.deviation > allowed || e.most > kMostDraw * allowed) return true;
  }
  return false;
}

// One VPL for all lanes. The loops over lanes are written for the compiler to vectorise.
void TileGatherer::addCluster(const LightNode& cluster, float u, float roulette, float negligible,
                              Packet& p) const {
  const VplDraw vpl = tree_.draw(cluster, u);
  const Vec3 at = vpls_.position[vpl.index], normal = vpls_.normal[vpl.index];
  const float clamp2 = vpls_.clamp2[vpl.index];
  alignas(64) Packet::Lanes transfer, clamped;
  alignas(64) std::array<int, Packet::kSize> faces;
  for (uint32_t l = 0; l < Packet::kSize; ++l) {
    const float dx = at.x - p.x[l], dy = at.y - p.y[l], dz = at.z - p.z[l];
    const float d2 = dx * dx + dy * dy + dz * dz;
    const float emitter = -(normal.x * dx + normal.y * dy + normal.z * dz);
    const float receiver = p.sx[l] * dx + p.sy[l] * dy + p.sz[l] * dz;
    const float above = p.gx[l] * dx + p.gy[l] * dy + p.gz[l] * dz;
    const float far2 = d2 > clamp2 ? d2 : clamp2;
    const float far4 = d2 * far2;  // 0 where the VPL is at the point
    faces[l] = (emitter > 0.0f) & (receiver > 0.0f) & (above > 0.0f) & (far4 > 0.0f);
    transfer[l] = emitter * receiver / far4;
    clamped[l] = far2 / d2 - 1.0f;
  }
  uint32_t mask = 0;
  for (uint32_t l = 0; l < Packet::kSize; ++l) mask |= static_cast<uint32_t>(faces[l]) << l;
  mask &= p.used;
  if (mask == 0) return;
  // What is too little to matter to any lane is looked at now and then, and counted the more.
  Vec3 light = vpls_.intensity[vpl.index] * vpl.weight;
  float most = 0.0f;
  for (uint32_t l = 0; l < Packet::kSize; ++l) {
    most = std::max(most, (mask >> l & 1u) != 0 ? transfer[l] : 0.0f);
  }
  const float chance = most * p.brightest * (light.x + light.y + light.z) / negligible;
  if (chance < 1.0f) {
    if (roulette >= chance || chance < kLeastProbability) return;
    light *= 1.0f / chance;
  }
  for (uint32_t rest = mask; rest != 0; rest &= rest - 1) ++p.shadowRays[std::countr_zero(rest)];
  mask &= ~rays_.occluded(p.from, at, mask);
  if (mask == 0) return;

  for (uint32_t l = 0; l < Packet::kSize; ++l) {
    const float t = (mask >> l & 1u) != 0 ? transfer[l] : 0.0f;
    const float c = (mask >> l & 1u) != 0 ? transfer[l] * clamped[l] : 0.0f;
    p.red[l] += t * light.x;
    p.green[l] += t * light.y;
    p.blue[l] += t * light.z;
    p.clampedRed[l] += c * light.x;
    p.clampedGreen[l] += c * light.y;
    p.clampedBlue[l] += c * light.z;
  }
  // A lobe depends on the direction: what it adds to the diffuse value, one by one.
  for (uint32_t rest = mask & p.lobes; rest != 0; rest &= rest - 1) {
    const auto l = static_cast<uint32_t>(std::countr_zero(rest));
    const Vec3 direction = normalize(at - p.bsdf[l]->point().position);
    const float cosine = dot(p.bsdf[l]->point().ns, direction);
    const Vec3 lobe =
        p.bsdf[l]->eval(LobeGroup::Rough, direction) * (1.0f / cosine) - p.bsdf[l]->diffuseValue();
    const Vec3 reflected = lobe * light * transfer[l];
    p.glossy[l] += reflected;
    p.glossyClamped[l] += reflected * clamped[l];
  }
}

}  // namespace bnvpl
