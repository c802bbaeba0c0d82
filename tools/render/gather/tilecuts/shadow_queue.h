// Queue of contributions to packets of receivers that wait for their shadow rays. Rays are traced
// in the order of their receivers' pixels, so that rays that are traced together are coherent,
// although the receivers that share a VPL are spread over the image.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/gather/tilecuts/receiver_packet.h"
#include "tools/render/light_tree/light_tree.h"

namespace bnvpl {

class ShadowQueue {
 public:
  // Borrows all. The packets must not move.
  ShadowQueue(const Accelerator& accel, const VplLights& vpls, std::span<ReceiverPacket> packets);

  // Adds the light of a VPL, drawn from a cluster, to all receivers of one of the packets. A
  // contribution that is below `negligible` (W/(m2 sr)) for all of them is subject to Russian
  // roulette. Calls with neighbouring VPLs should follow each other.
  void add(ReceiverPacket& packet, const VplDraw& vpl, uint32_t cluster, float negligible);
  // Traces the waiting rays and adds their light to the packets. Must be called at the end.
  void flush();

 private:
  using Lanes = ReceiverPacket::Lanes;
  struct PendingContribution {
    ReceiverPacket* packet;
    Vec3 at;         // position of the VPL
    Vec3 light;      // weighted intensity of the VPL, W/sr
    uint32_t vpl;
    float weight;    // factor of its intensity
    uint32_t lanes;  // mask of the lanes that may see it
    alignas(64) Lanes transfer;
    alignas(64) Lanes clampLoss;  // light that the bound on 1/d^2 removed, over the rest
  };
  // Light of a VPL that is no product of BSDF and irradiance (VplLights::kind), by lane: BSDF and
  // cosines over its sphere, 1/m2.
  using Integrated = std::array<Vec3, ReceiverPacket::kSize>;
  struct Ray {
    uint32_t pending, lane;
  };

  // Mask of the lanes that the VPL may light, and their transfer.
  uint32_t integrate(ReceiverPacket& p, uint32_t vpl, Lanes& transfer);
  void removeLast();
  void traceAll();
  static void accumulate(const PendingContribution& d);
  void accumulateGroups(const PendingContribution& d) const;
  void accumulateIntegrated(const PendingContribution& d, const Integrated& light) const;

  const Accelerator& accel_;
  const VplLights& vpls_;
  std::vector<PendingContribution> waiting_;
  std::vector<Integrated> integrated_;  // one for each that waits, or empty
  std::vector<uint32_t> rayCount_;  // rays per place; while tracing, where those of a place begin
  size_t raysWaiting_ = 0;
  std::vector<Ray> order_;
  std::vector<Segment> segments_;
  std::vector<uint8_t> hidden_;
};

}  // namespace bnvpl
