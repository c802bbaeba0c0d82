// The binary tree of Lightcuts (Walter et al. 2005): clusters of VPLs, each with a representative.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/virtual_light/virtual_light.h"

namespace bnvpl {

inline constexpr size_t kMaxStartCut = 32;

// A VPL that was drawn with this probability, > 0.
struct VplSample {
  uint32_t vpl;
  float probability;
};

// One VPL of a cluster, and the factor of its intensity with which it represents the cluster.
struct VplDraw {
  uint32_t index;
  float weight;
};

// A basis about an axis, stored by coordinate: x holds the x of both tangents and of the axis.
struct AxisFrame {
  alignas(16) float x[4] = {}, y[4] = {}, z[4] = {};
  AxisFrame() = default;
  explicit AxisFrame(Vec3 axis) {
    const Frame b(axis);
    x[0] = b.s.x, x[1] = b.t.x, x[2] = b.n.x;
    y[0] = b.s.y, y[1] = b.t.y, y[2] = b.n.y;
    z[0] = b.s.z, z[1] = b.t.z, z[2] = b.n.z;
  }
};

struct LightNode {
  Bounds bounds;                                   // union of the boxes of its VPLs
  Vec3 axis;                                       // axis of the cone of normals
  AxisFrame frame;                                 // basis about the axis
  float cosHalfAngle = 1.0f, sinHalfAngle = 0.0f;  // sine of at most a right angle
  Vec3 intensity;                                  // sum over the cluster, W/sr
  VplKind kind = {};
  float size2 = 0.0f;  // smallest in the cluster, so that bounds hold for all of its VPLs
  // Distance by which `bounds` exceeds the box of its VPLs' centres (VplLights::box).
  float boxMargin = 0.0f;
  uint32_t representative = 0;
  uint32_t left = 0, right = 0;  // both are 0 in a leaf
  uint32_t begin = 0, end = 0;   // range of its VPLs in LightTree::order
  bool leaf() const { return left == 0; }
  // About the box of its VPLs' centres, which tells how much their light varies.
  Bounds centres() const {
    return {bounds.lower + Vec3(boxMargin), bounds.upper - Vec3(boxMargin)};
  }
  // Upper bound of its VPLs' falloff, 1/m2.
  float maxFalloff(float distanceSquared) const {
    return bnvpl::maxFalloff(kind, distanceSquared, size2);
  }
};

struct LightTree {
  std::vector<LightNode> nodes;  // nodes[0] is the root; empty without VPLs
  // Clusters from which every cut is refined. The root is no good start: an occluded representative
  // would make the total 0, and a very near one would end refinement at once.
  std::vector<uint32_t> startCut;
  std::vector<uint32_t> order;  // VPLs from left to right
  std::vector<double> upTo;     // running sums of their mean intensities; has one entry more
  uint32_t groups = 0;          // light groups; 0: not told apart
  std::vector<Vec3> groupIntensity;  // `groups` for each node, which add up to its intensity

  // Adds the light of a cluster by group. `transfer`: light over intensity.
  void addByGroup(uint32_t node, Vec3 transfer, const LightGroupSink& sink) const {
    for (uint32_t g = 0; g < groups; ++g)
      sink.add(g, transfer * groupIntensity[size_t{node} * groups + g]);
  }

  // Splits the cluster with the largest intensity times size, until there are `count`. The tree has
  // VPLs.
  std::vector<uint32_t> coarseCut(size_t count) const;
  // Draws a VPL of the cluster in proportion to intensity; u in [0, 1).
  VplDraw draw(const LightNode& n, float u) const { return at(n, drawPlace(n, u)); }
  // The same as a place in `order`, and the VPL there as a draw from a cluster that holds it.
  uint32_t drawPlace(const LightNode& n, float u) const;
  VplDraw at(const LightNode& n, uint32_t place) const;
};

// How a cluster is split: at the middle of its longest side of position and scaled normal, or where
// the orientation heuristic costs least (orientation_split.h).
enum class LightSplit { Middle, Orientation };

// Builds the tree top-down in O(N log N). A parent takes the representative of one child, drawn in
// proportion to intensity. Deterministic for a seed. Throws MemoryError if it would not fit.
LightTree buildLightTree(const VplLights& vpls, uint64_t seed, LightSplit by = LightSplit::Middle);

}  // namespace bnvpl
