// Packet of sixteen receivers that share their VPLs, with the light that arrives at them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/gather/gather.h"
#include "tools/render/light_tree/cluster_deviation.h"

namespace bnvpl {

struct ReceiverPacket {
  static constexpr uint32_t kSize = 16;
  using Lanes = std::array<float, kSize>;
  // The light of one light group.
  struct GroupLanes {
    alignas(64) Lanes red{}, green{}, blue{};  // irradiance, W/m2
    std::array<Vec3, kSize> glossy{};          // radiance of glossy lobes
  };

  alignas(64) Lanes x{}, y{}, z{}, sx{}, sy{}, sz{}, gx{}, gy{}, gz{};  // point; ns; ng
  // Channels of maxReflected(), 1/sr; 0 in an empty lane.
  alignas(64) Lanes maxReflectedRed{}, maxReflectedGreen{}, maxReflectedBlue{};
  alignas(64) Lanes red{}, green{}, blue{};  // irradiance, W/m2
  alignas(64) Lanes clampedRed{}, clampedGreen{}, clampedBlue{};
  std::array<Vec3, kSize> offset{};                   // offset ray origins
  // Radiance of glossy lobes, and of light that is integrated with the BSDF.
  std::array<Vec3, kSize> glossy{}, glossyClamped{};
  std::array<const Bsdf*, kSize> bsdf{};
  std::array<uint32_t, kSize> receiver{};    // index among the tile's receivers
  std::array<uint32_t, kSize> pixelOrder{};  // neighbours in the image have neighbouring places
  std::array<uint32_t, kSize> shadowRays{}, sampledPairs{};
  uint32_t count = 0;
  uint32_t lobes = 0;  // mask of the lanes with glossy lobes
  uint32_t clusters = 0;
  Bounds bounds;               // bounds of the points
  float brightest = 0.0f;      // maximum of maxReflected() over receivers and channels, 1/sr
  float stratumOffset = 0.0f;  // shift of its draws along each cluster, in [0, 1)
  uint64_t rouletteKey = 0;
  uint32_t rouletteDraw = 0;
  std::vector<GroupLanes> groups;  // empty: not told apart

  void add(uint32_t receiverOfTile, const Bsdf& b, Vec3 offsetPoint, uint32_t orderInTile) {
    const uint32_t lane = count++;
    const SurfacePoint& p = b.point();
    bsdf[lane] = &b;
    receiver[lane] = receiverOfTile;
    offset[lane] = offsetPoint;
    pixelOrder[lane] = orderInTile;
    x[lane] = p.position.x, y[lane] = p.position.y, z[lane] = p.position.z;
    sx[lane] = p.ns.x, sy[lane] = p.ns.y, sz[lane] = p.ns.z;
    gx[lane] = p.ng.x, gy[lane] = p.ng.y, gz[lane] = p.ng.z;
    bounds.extend(p.position);
    const Vec3 bound = maxReflected(b);
    maxReflectedRed[lane] = bound.x;
    maxReflectedGreen[lane] = bound.y;
    maxReflectedBlue[lane] = bound.z;
    brightest = std::max(brightest, maxComponent(bound));
    if (!b.diffuseOnly()) lobes |= 1u << lane;
  }

  void writeTo(const TileReceivers& tile, std::span<Gathered> out) const {
    for (uint32_t l = 0; l < count; ++l) {
      Gathered& g = out[receiver[l]];
      const Vec3 value = bsdf[l]->diffuseValue();
      g.radiance = value * Vec3(red[l], green[l], blue[l]) + glossy[l];
      g.clamped = value * Vec3(clampedRed[l], clampedGreen[l], clampedBlue[l]) + glossyClamped[l];
      g.cut = clusters;
      g.shadowRays = shadowRays[l];
      g.sampledPairs = sampledPairs[l];
      for (uint32_t k = 0; k < groups.size(); ++k) {
        const GroupLanes& of = groups[k];
        tile.groupsOf(receiver[l])
            .add(k, value * Vec3(of.red[l], of.green[l], of.blue[l]) + of.glossy[l]);
      }
    }
  }
};

}  // namespace bnvpl
