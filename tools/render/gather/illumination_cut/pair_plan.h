// The pairs of clusters that IlluminationCut finds for the film: groups of receivers, each with a
// cluster of VPLs that one of them may represent there.
#pragma once

#include "tools/render/gather/gather.h"
#include "tools/render/gather/receiver_tree.h"

namespace bnvpl::methods::gather::illumination_cut {

struct PairOptions {
  double error;           // bound on the error of a pair, over the light of the darkest receiver
  size_t visibilityRays;  // max rays that decide on the visibility of a pair; 0: none does
};

// A cluster of VPLs for all receivers of a node.
struct LightPair {
  uint32_t light;
  bool seen;  // all receivers that were asked see the representative; else each traces a ray
};

struct PairPlan {
  ReceiverTree tree;            // holds the film's points
  float normalScale = 1.0f;     // scale of normals in the tree
  std::vector<uint64_t> begin;  // range of each node's pairs; has one entry more
  std::vector<LightPair> pairs;
  uint64_t rays = 0;  // shadow rays that the plan took

  // Calls fn for every pair of a point: those of the nodes on the way to the leaf in whose part of
  // space it lies, by position and normal. A film's point comes to its own leaf.
  template <typename Fn>
  void forEachPair(const SurfacePoint& at, const Fn& fn) const {
    if (tree.nodes.empty()) return;
    for (uint32_t node = 0;;) {
      for (uint64_t k = begin[node]; k < begin[node + 1]; ++k) fn(pairs[k]);
      const ReceiverNode& n = tree.nodes[node];
      if (n.leaf()) return;
      node = coordinate(at, n.axis, normalScale) < n.middle ? n.left : n.right;
    }
  }
};

PairPlan makePairPlan(const GatherInputs& in, const PairOptions& options);

}  // namespace bnvpl::methods::gather::illumination_cut
