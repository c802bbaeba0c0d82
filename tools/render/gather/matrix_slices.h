// Slices of the visible points, and the clusters of VPLs of each (Ou & Pellacini, "LightSlice:
// Matrix Slice Sampling for the Many-Lights Problem", SIGGRAPH Asia 2011).
#pragma once

#include <array>
#include <vector>

#include "tools/render/gather/matrix_columns.h"

namespace bnvpl {

inline constexpr WholeOption kSlicesOption =
    countOption("slices", "300", 0x1p20, "", "minimal number of groups of neighbouring points");
inline constexpr WholeOption kColumnsOption =
    countOption("columns", "600", 0x1p20, "", "clusters of VPLs for each slice");
inline constexpr WholeOption kNeighbourSlicesOption =
    countOption("neighbour-slices", "8", 1024, "", "rows that refine a slice's clusters");

// Position, and normal times a length.
using Placement = std::array<double, 6>;

// A point; or a slice with its centre and a point that represents it.
struct PlacedPoint {
  Placement at;
  SurfacePoint point;
};

// The VPLs of each slice, one per cluster.
struct SlicePlan {
  // A node of the tree of slices: places below `middle` on the axis belong to node `below`, the
  // others to `below` + 1.
  struct Node {
    uint32_t axis = 0;
    double middle = 0.0;
    uint32_t below = 0;  // 0: a leaf
    uint32_t slice = 0;  // that of a leaf
  };
  float scale = 1.0f;       // scale of normals
  std::vector<Node> nodes;  // nodes[0] is the root; empty if there are no VPLs
  std::vector<PlacedPoint> slices;  // one without a row where the film's points miss the scene
  size_t rows = 0;                  // rows of the matrix evaluated
  std::vector<ClusterDraws> draws;  // empty if there are no VPLs
  // The slice in whose part of space the point lies. There are slices.
  size_t sliceOf(const SurfacePoint& point) const;
};

// Evaluates a row of the matrix for each slice and finds its clusters. Reads the options above.
SlicePlan makeSlicePlan(const GatherInputs& in, const Values& options);

}  // namespace bnvpl
