// The binary tree of Lightcuts (Walter et al. 2005): clusters of VPLs, each with a representative.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/virtual_light.h"

namespace bnvpl {

inline constexpr size_t kMaxStartCut = 32;

// One VPL of a cluster, and what its intensity counts for to stand for the whole.
struct VplDraw {
  uint32_t index;
  float weight;
};

// A basis about an axis, by coordinate: x holds the x of both tangents and of the axis.
struct AxisFrame {
  alignas(16) float x[4] = {}, y[4] = {}, z[4] = {};
  AxisFrame() = default;
  explicit AxisFrame(Vec3 axis) {
    const Basis b(axis);
    x[0] = b.s.x, x[1] = b.t.x, x[2] = b.n.x;
    y[0] = b.s.y, y[1] = b.t.y, y[2] = b.n.y;
    z[0] = b.s.z, z[1] = b.t.z, z[2] = b.n.z;
  }
};

struct LightNode {
  Bounds bounds;
  Vec3 axis;                                       // of the cone of normals
  AxisFrame frame;                                 // about it
  float cosHalfAngle = 1.0f, sinHalfAngle = 0.0f;  // sine of at most a right angle
  Vec3 intensity;                                  // sum over the cluster, W/sr
  LightKind kind = {};
  float clamp2 = 0.0f;  // smallest of the cluster, so that the bound holds for all
  uint32_t representative = 0;
  uint32_t left = 0, right = 0;  // both 0: a leaf
  uint32_t begin = 0, end = 0;   // its VPLs, in LightTree::order
  bool leaf() const { return left == 0; }
  // Of its VPLs at most, 1/m2.
  float falloff(float distanceSquared) const {
    return bnvpl::falloff(kind, distanceSquared, clamp2);
  }
};

struct LightTree {
  std::vector<LightNode> nodes;  // nodes[0] is the root; empty without VPLs
  // Where every cut starts. Not at the root: one occluded representative would make the total 0,
  // one very near would end refinement at once (METHOD 4).
  std::vector<uint32_t> startCut;
  std::vector<uint32_t> order;  // VPLs from left to right
  std::vector<double> upTo;     // running sum of their mean intensities; one more than VPLs

  // In proportion to intensity, by u in [0, 1).
  VplDraw draw(const LightNode& n, float u) const;
};

// Splits from the top along the longest side of position and (scaled) normal, O(N log N);
// representatives in proportion to intensity, a parent sharing one child's. Deterministic for a
// seed.
LightTree buildLightTree(const VplLights& vpls, uint64_t seed);

}  // namespace bnvpl
