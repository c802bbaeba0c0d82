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
  // Rays for indirect light from a shading point.
  kDimRay = 16,
  // The specular path of a sample's camera ray.
  kDimCameraPath = 17,
  // Representatives of a pixel's samples (gather/multidimensional).
  kDimRepresentatives = 18,
  // Local virtual lights (compensate/local).
  kDimLocalLights = 19,
  // Receivers of a slice's clusters (gather/matrix_completion).
  kDimMatrixPart = 20,
  // The pilots of sample allocation among the rays for indirect light: the first for parity 0, the
  // second for parity 1.
  kDimPilotRays0 = 24,
  kDimPilotRays1 = kDimPilotRays0 + 1,
  // Shadow rays to lights.
  kDimLight = 1u << 30,
  // Rays for indirect light that sample allocation adds, by parity.
  kDimMoreRays0 = 5u << 28,
  kDimMoreRays1 = kDimMoreRays0 + 1,
  // Pilots of the camera samples of direct light.
  kDimDirectPilots = 3u << 29,
  // Further camera rays of a pixel for the control variate.
  kDimControlRays = 13u << 27,
  // Camera samples of direct light.
  kDimDirectSamples = 7u << 28,
  // Further camera rays of a pixel for emission.
  kDimEmissionRays = 1u << 31,
  // The pattern of parities and blocks of a sample index.
  kDimParity = 11u << 28
};

namespace dimensions {
inline constexpr std::array kAll{
    kDimReceiver,     kDimVpl,         kDimStratum,         kDimPacket,       kDimRoulette,
    kDimRay,          kDimCameraPath,  kDimRepresentatives, kDimLocalLights,  kDimMatrixPart,
    kDimPilotRays0,   kDimPilotRays1,  kDimLight,           kDimMoreRays0,    kDimMoreRays1,
    kDimDirectPilots, kDimControlRays, kDimDirectSamples,   kDimEmissionRays, kDimParity};
constexpr bool distinct() {
  for (size_t i = 0; i < kAll.size(); ++i)
    if (std::count(kAll.begin(), kAll.end(), kAll[i]) != 1) return false;
  return true;
}
static_assert(distinct());
}  // namespace dimensions

}  // namespace bnvpl
