// An octree of VPLs for each octant of their normals (Paquette, Poulin & Drettakis 1998).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "tools/render/light_tree/normal_cone.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl::methods::gather::paquette {

// Node k stands for its VPLs by the light k of LightOctree::lights.
struct OctreeNode {
  Bounds bounds;
  NormalCone cone;
  float minSize2 = INFINITY, maxSize2 = 0.0f;    // extremes over its VPLs
  uint32_t shadow = 0;                           // VPL that is tested for all
  uint32_t firstChild = 0, children = 0;
  bool leaf() const { return children == 0; }  // a single VPL
};

struct LightOctree {
  std::vector<OctreeNode> nodes;
  std::vector<uint32_t> roots;
  // Mean positions and normals, weighted by intensity, and summed intensities. The normals are
  // shorter than 1 where they differ, so that emission is the sum of the VPLs'.
  VplLights lights;
};

// Random numbers choose the VPL that is tested for a node, in proportion to intensity.
LightOctree buildLightOctree(const VplLights& vpls, uint64_t key);

}  // namespace bnvpl::methods::gather::paquette
