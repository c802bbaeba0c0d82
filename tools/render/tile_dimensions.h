// The random numbers of a tile, random64(tile.key, index, dimension). Each purpose has a dimension
// of its own; the values decide the bytes of images and never change.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace bnvpl {

enum TileDimension : uint32_t {
  // Receivers: of tile cuts (gather/tilecuts), and of gathers that handle each alone (gatherEach).
  kDimReceiver = 0,
  kDimVpl = 1,
  kDimStratum = 2,
  kDimPacket = 3,
  kDimRoulette = 4,  // to 7: one for each packet, under keys of their own (ReceiverPacket)
  // Representatives of a pixel's samples (gather/multidimensional).
  kDimReceivers = 18,
  // Receivers of a slice's clusters (gather/matrix_completion).
  kDimMatrixPart = 20,
  // Local virtual lights (compensate/local).
  kDimLocalLights = 19,
  // Rays for indirect light from a shading point, and those that sample allocation adds: the first
  // for parity 0, the second for parity 1.
  kDimRay = 16,
  kDimMoreRays0 = 5u << 28,
  kDimMoreRays1 = kDimMoreRays0 + 1,
  // The pilots of sample allocation among these rays, by parity.
  kDimPilotRays0 = 24,
  kDimPilotRays1 = kDimPilotRays0 + 1,
  // Camera rays: the specular path of a sample, further rays of a pixel for emission and for the
  // control variate, and camera samples of direct light with their pilots.
  kDimCameraPath = 17,
  kDimEmissionRays = 1u << 31,
  kDimControlRays = 13u << 27,
  kDimDirectSamples = 7u << 28,
  kDimDirectPilots = 3u << 29,
  // Shadow rays to lights.
  kDimLight = 1u << 30,
  // The pattern of parities and blocks of a sample index.
  kDimParity = 11u << 28
};

namespace dimensions {
inline constexpr std::array kAll{
    kDimReceiver,   kDimVpl,          kDimStratum,     kDimPacket,        kDimRoulette,
    kDimReceivers,  kDimLocalLights,  kDimRay,         kDimMoreRays0,     kDimMoreRays1,
    kDimCameraPath, kDimEmissionRays, kDimControlRays, kDimDirectSamples, kDimDirectPilots,
    kDimLight,      kDimParity,       kDimMatrixPart,  kDimPilotRays0,    kDimPilotRays1};
constexpr bool distinct() {
  for (size_t i = 0; i < kAll.size(); ++i)
    if (std::count(kAll.begin(), kAll.end(), kAll[i]) != 1) return false;
  return true;
}
static_assert(distinct());
}  // namespace dimensions

}  // namespace bnvpl
