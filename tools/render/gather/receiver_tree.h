// A binary tree of receivers, for methods that treat receivers and lights as pairs of clusters
// (Walter et al. 2006), and bounds on such pairs.
#pragma once

#include <span>
#include <vector>

#include "tools/render/light_tree/light_tree.h"
#include "tools/render/light_tree/normal_cone.h"
#include "tools/render/light_tree/tree_building.h"
#include "transport/bsdf.h"

namespace bnvpl {

// What bounds need of a receiver's rough lobes.
struct ReceiverBsdf {
  Vec3 diffuse;  // constant part of the BSDF, 1/sr
  Vec3 glossy;   // largest value times cosine of the other lobes, 1/sr
  explicit ReceiverBsdf(const Bsdf& bsdf);
  ReceiverBsdf() = default;
};

struct ReceiverNode {
  Bounds bounds;
  NormalCone normals;
  AxisFrame frame;               // basis about the axis of the normals
  ReceiverBsdf bsdf;             // largest of the receivers
  uint32_t left = 0, right = 0;  // both are 0 in a leaf
  uint32_t begin = 0, end = 0;   // range of its receivers in ReceiverTree::order
  // The left child has the receivers whose coordinate() along `axis` is below `middle`.
  uint8_t axis = 0;
  float middle = 0.0f;
  bool leaf() const { return left == 0; }
};

// Place of a point along one of six axes: those of its position, then those of its shading normal
// times `normalScale`.
inline float coordinate(const SurfacePoint& p, size_t axis, float normalScale) {
  return axis < 3 ? p.position[axis] : normalScale * p.ns[axis - 3];
}

// Children stand behind their parents; a leaf has one receiver.
struct ReceiverTree {
  std::vector<ReceiverNode> nodes;  // nodes[0] is the root; empty without receivers
  std::vector<uint32_t> order;
};

// Splits along the longest side of position and scaled normal, like the light tree. `normalScale`:
// length of a unit normal in that space, world units. All spans have one entry for each receiver.
ReceiverTree buildReceiverTree(std::span<const SurfacePoint> points,
                               std::span<const ReceiverBsdf> bsdfs, float normalScale);

// Upper bound of the light of a cluster of VPLs at any one receiver of a node, summed over the
// channels; visibility is taken as 1. `only`: the BSDF of a leaf's receiver for a tighter bound, or
// null. The differences between the two boxes are a box of directions (Walter et al. 2006).
float pairBound(const LightNode& light, const ReceiverNode& node, const Bsdf* only);

}  // namespace bnvpl
