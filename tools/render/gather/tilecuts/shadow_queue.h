// Light on its way to packets of receivers, until it is known which of them see it. Rays wait for
// each other and are traced in the order of their receivers' pixels: what shares its VPL has to be
// spread over the image, what is traced together should be as near to each other as can be.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/gather/tilecuts/receiver_packet.h"
#include "tools/render/light_tree/light_tree.h"

namespace bnvpl {

class ShadowQueue {
 public:
  // Borrows all; the packets stay where they are.
  ShadowQueue(const RayScene& rays, const VplLights& vpls, std::span<ReceiverPacket> packets);

  // The light of a VPL, drawn from a cluster, to all receivers of one of the packets. What is less
  // than `negligible` (W/(m2 sr)) for all of them is left to chance. Calls with neighbouring VPLs
  // should follow each other.
  void add(ReceiverPacket& packet, const VplDraw& vpl, uint32_t cluster, float negligible);
  // Traces what waits and adds it to the packets. Call it at the end.
  void flush();

 private:
  using Lanes = ReceiverPacket::Lanes;
  struct Delivery {
    ReceiverPacket* packet;
    Vec3 at;         // the VPL
    Vec3 light;      // its intensity, W/sr, for all that it stands for
    uint32_t lanes;  // mask of those that may see it
    alignas(64) Lanes transfer;
    alignas(64) Lanes clamped;  // what the bound on 1/d^2 removed, over what it left
  };
  struct Ray {
    uint32_t delivery, lane;
  };

  void traceAll();
  static void deliver(const Delivery& d);

  const RayScene& rays_;
  const VplLights& vpls_;
  std::vector<Delivery> waiting_;
  std::vector<uint32_t> rayCount_;  // of the place, then where its rays begin
  size_t raysWaiting_ = 0;
  std::vector<Ray> order_;
  std::vector<Segment> segments_;
  std::vector<uint8_t> hidden_;
};

}  // namespace bnvpl
