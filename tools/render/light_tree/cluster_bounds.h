// Upper bounds of the light that a cluster of the light tree sends to a point.
#pragma once

#include "tools/render/light_tree/light_tree.h"
#include "transport/bsdf.h"

namespace bnvpl {

// A receiver, with values that all clusters share.
struct ClusterReceiver {
  explicit ClusterReceiver(const Bsdf& b) : bsdf(b), normal(b.point().ns) {}
  const Bsdf& bsdf;
  AxisFrame normal;
};

// Largest cosine between the frame's axis and any direction from `at` into the box (Walter et al.
// 2005, section 4.1).
float maxCosine(const Bounds& box, Vec3 at, const AxisFrame& frame);

// Upper bound of a cluster's contribution without 1/d^2 and visibility: BSDF, cosines and
// intensity, summed over the channels, W/sr.
float sentBound(const LightNode& n, const ClusterReceiver& receiver);

// Squared distance to the farthest point of a box.
inline float farthestSquared(const Bounds& box, Vec3 at) {
  return lengthSquared(max(at - box.lower, box.upper - at));
}

// Upper bound on the error if one VPL represents the cluster, summed over the channels; visibility
// is taken as 1 (Walter et al. 2005, section 4.1). 0 for a leaf.
float errorBound(const LightNode& n, const ClusterReceiver& receiver);

}  // namespace bnvpl
