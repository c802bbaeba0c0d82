#include "tools/render/gather/tilecuts/shadow_queue.h"

#include <algorithm>
#include <array>
#include <bit>

namespace bnvpl {

namespace {

// Number of rays that wait: enough for coherence, few enough to stay in the cache.
constexpr size_t kWaiting = 256;

// Transfer from a VPL to all receivers of a packet. Returns the mask of those that it may light.
// The compiler can vectorise the loops over lanes.
template <typename Kind>
uint32_t geometryOfPacket(const VplLights& vpls, uint32_t i, const ReceiverPacket& p,
                          ReceiverPacket::Lanes& transfer, ReceiverPacket::Lanes& clampLoss) {
  const Vec3 at = vpls.position[i], normal = vpls.normal[i];
  const float size2 = vpls.size2[i];
  alignas(64) std::array<int, ReceiverPacket::kSize> contributes;
  for (uint32_t l = 0; l < ReceiverPacket::kSize; ++l) {
    const GeometryTerm c =
        geometryTerm<Kind>(at, normal, size2, {p.x[l], p.y[l], p.z[l]}, {p.sx[l], p.sy[l], p.sz[l]},
                           {p.gx[l], p.gy[l], p.gz[l]});
    contributes[l] = c.contributes, transfer[l] = c.value, clampLoss[l] = c.clampLoss;
  }
  uint32_t lanes = 0;
  for (uint32_t l = 0; l < ReceiverPacket::kSize; ++l) {
    lanes |= static_cast<uint32_t>(contributes[l]) << l;
  }
  return lanes & ((1u << p.count) - 1);
}

// The part of a VPL's light that a glossy BSDF reflects beyond the diffuse value, by which
// ReceiverPacket::writeTo() multiplies irradiance. eval() includes the cosine, as the transfer
// does.
Vec3 glossyOf(const ReceiverPacket& p, uint32_t lane, Vec3 from) {
  const Bsdf& b = *p.bsdf[lane];
  const Vec3 direction = normalize(from - b.point().position);
  const float cosine = dot(b.point().ns, direction);
  if (!(cosine > 1e-30f)) return {};  // it is positive in the transfer, but rounds to 0 here
  return b.eval(LobeGroup::Rough, direction) * (1.0f / cosine) - b.diffuseValue();
}

}  // namespace

ShadowQueue::ShadowQueue(const Accelerator& accel, const VplLights& vpls,
                         std::span<ReceiverPacket> packets)
    : accel_(accel), vpls_(vpls) {
  uint32_t places = 0;
  for (const ReceiverPacket& p : packets) {
    for (uint32_t l = 0; l < p.count; ++l) places = std::max(places, p.pixelOrder[l] + 1);
  }
  rayCount_.assign(places, 0);
}

void ShadowQueue::add(ReceiverPacket& p, const VplDraw& vpl, uint32_t cluster, float negligible) {
  PendingContribution& d = waiting_.emplace_back();
  d.packet = &p;
  d.at = vpls_.position[vpl.index];
  const uint32_t lanes = withKind(vpls_.kind, [&](auto kind) {
    if constexpr (kind.fromCentre) {
      return geometryOfPacket<decltype(kind)>(vpls_, vpl.index, p, d.transfer, d.clampLoss);
    } else {
      return integrate(p, vpl.index, d.transfer);
    }
  });
  if (lanes == 0) return removeLast();
  d.light = vpls_.intensity[vpl.index] * vpl.weight;
  d.vpl = vpl.index, d.weight = vpl.weight;
  float largest = 0.0f;
  for (uint32_t l = 0; l < ReceiverPacket::kSize; ++l) {
    largest = std::max(largest, (lanes >> l & 1u) != 0 ? d.transfer[l] : 0.0f);
  }
  const float survivalProbability =
      largest * p.brightest * (d.light.x + d.light.y + d.light.z) / negligible;
  if (survivalProbability < 1.0f) {
    const float roulette = toUnitFloat(random64(p.rouletteKey, cluster, p.rouletteDraw));
    if (roulette >= survivalProbability || survivalProbability < kMinProbability)
      return removeLast();
    d.light *= 1.0f / survivalProbability;
    d.weight *= 1.0f / survivalProbability;
  }
  d.lanes = lanes;
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const auto l = static_cast<uint32_t>(std::countr_zero(rest));
    ++p.shadowRays[l];
    ++rayCount_[p.pixelOrder[l]];
  }
  raysWaiting_ += static_cast<size_t>(std::popcount(lanes));
  if (raysWaiting_ >= kWaiting) flush();
}

void ShadowQueue::flush() {
  traceAll();
  for (size_t i = 0; i < waiting_.size(); ++i) {
    const PendingContribution& d = waiting_[i];
    if (!integrated_.empty()) {
      accumulateIntegrated(d, integrated_[i]);
      continue;
    }
    accumulate(d);
    if (!d.packet->groups.empty()) accumulateGroups(d);
  }
  waiting_.clear();
  integrated_.clear();
}

void ShadowQueue::removeLast() {
  waiting_.pop_back();
  if (!integrated_.empty()) integrated_.pop_back();
}

// Roulette multiplies `transfer` by the packet's brightest BSDF, which is part of the light here.
uint32_t ShadowQueue::integrate(ReceiverPacket& p, uint32_t vpl, Lanes& transfer) {
  Integrated& light = integrated_.emplace_back();
  uint32_t lanes = 0;
  for (uint32_t l = 0; l < p.count; ++l) {
    VplTransfer found;
    if (!unoccludedTransfer(vpls_, vpl, *p.bsdf[l], found)) continue;
    lanes |= 1u << l;
    light[l] = found.transfer;
    p.sampledPairs[l] += found.sampled;
    transfer[l] = maxComponent(found.transfer) / p.brightest;
  }
  return lanes;
}

// Sorts rays by place, and those of the same place by the order of the VPLs.
void ShadowQueue::traceAll() {
  uint32_t begin = 0;
  for (uint32_t& n : rayCount_) {
    const uint32_t count = n;
    n = begin;
    begin += count;
  }
  order_.resize(raysWaiting_);
  segments_.resize(raysWaiting_);
  hidden_.resize(raysWaiting_);
  for (uint32_t i = 0; i < waiting_.size(); ++i) {
    const PendingContribution& d = waiting_[i];
    for (uint32_t rest = d.lanes; rest != 0; rest &= rest - 1) {
      const auto l = static_cast<uint32_t>(std::countr_zero(rest));
      const uint32_t at = rayCount_[d.packet->pixelOrder[l]]++;
      order_[at] = {i, l};
      segments_[at] = {d.packet->offset[l], d.at};
    }
  }
  accel_.occluded(segments_, hidden_);
  for (size_t k = 0; k < order_.size(); ++k) {
    waiting_[order_[k].pending].lanes &= ~(uint32_t{hidden_[k]} << order_[k].lane);
  }
  std::fill(rayCount_.begin(), rayCount_.end(), 0);
  raysWaiting_ = 0;
}

void ShadowQueue::accumulateGroups(const PendingContribution& d) const {
  ReceiverPacket& p = *d.packet;
  for (uint32_t k = 0; d.lanes != 0 && k < p.groups.size(); ++k) {
    const Vec3 light = vpls_.groupIntensity[size_t{d.vpl} * vpls_.groups + k] * d.weight;
    if (isBlack(light)) continue;
    ReceiverPacket::GroupLanes& to = p.groups[k];
    for (uint32_t l = 0; l < ReceiverPacket::kSize; ++l) {
      const float t = (d.lanes >> l & 1u) != 0 ? d.transfer[l] : 0.0f;
      to.red[l] += t * light.x;
      to.green[l] += t * light.y;
      to.blue[l] += t * light.z;
    }
    for (uint32_t rest = d.lanes & p.lobes; rest != 0; rest &= rest - 1) {
      const auto l = static_cast<uint32_t>(std::countr_zero(rest));
      to.glossy[l] += glossyOf(p, l, d.at) * light * d.transfer[l];
    }
  }
}

void ShadowQueue::accumulateIntegrated(const PendingContribution& d,
                                       const Integrated& light) const {
  ReceiverPacket& p = *d.packet;
  for (uint32_t rest = d.lanes; rest != 0; rest &= rest - 1) {
    const auto l = static_cast<uint32_t>(std::countr_zero(rest));
    p.glossy[l] += light[l] * d.light;
    for (uint32_t k = 0; k < p.groups.size(); ++k) {
      const Vec3 own = vpls_.groupIntensity[size_t{d.vpl} * vpls_.groups + k] * d.weight;
      p.groups[k].glossy[l] += light[l] * own;
    }
  }
}

void ShadowQueue::accumulate(const PendingContribution& d) {
  if (d.lanes == 0) return;
  ReceiverPacket& p = *d.packet;
  for (uint32_t l = 0; l < ReceiverPacket::kSize; ++l) {
    const float t = (d.lanes >> l & 1u) != 0 ? d.transfer[l] : 0.0f;
    const float c = (d.lanes >> l & 1u) != 0 ? d.transfer[l] * d.clampLoss[l] : 0.0f;
    p.red[l] += t * d.light.x;
    p.green[l] += t * d.light.y;
    p.blue[l] += t * d.light.z;
    p.clampedRed[l] += c * d.light.x;
    p.clampedGreen[l] += c * d.light.y;
    p.clampedBlue[l] += c * d.light.z;
  }
  for (uint32_t rest = d.lanes & p.lobes; rest != 0; rest &= rest - 1) {
    const auto l = static_cast<uint32_t>(std::countr_zero(rest));
    const Vec3 reflected = glossyOf(p, l, d.at) * d.light * d.transfer[l];
    p.glossy[l] += reflected;
    p.glossyClamped[l] += reflected * d.clampLoss[l];
  }
}

}  // namespace bnvpl
