// Path reuse (Bekaert, Sbert & Halton 2002): the vertices of one sample's near-field rays also
// light the other samples of its group, as virtual lights that exist only for the group. A vertex
// can be reused if its radiance in one direction gives that in all directions (ExitantFactor:
// diffuse, bare or below a near-specular coat). Estimating that radiance takes many rays,
// connecting one more sample to the vertex only one.
//
// The rays of a group are techniques of one multi-sample MIS estimator (Veach 1997, section 9.2.2).
// Sample k sends n_k rays. A ray reaches the vertex y with the density, per unit area,
//
//   p_k(y) = pdf_k(x_k -> y) s_y(|x_k - y|) |cos_y| / |x_k - y|^2 V(x_k, y),
//
// where s_y is the uncovered share of y's light: the part that VPLs leave to rays, and the
// probability with which the ray evaluates y at all. With the balance heuristic the radiance L(y)
// of all vertices reaches sample j as
//
//   sum over y of  f_j(x_j -> y) s_y(|x_j - y|) |cos_y| / |x_j - y|^2 V(x_j, y) L(y)
//                  / sum over k of n_k p_k(y).
//
// Below a coat, L depends on the direction to x_j only by a factor. A ray that hits a coated vertex
// may follow the coat instead; L is divided by the probability that it did not, which p_k leaves
// out. No vertex has a larger weight than it would have with the rays of j alone. The estimator is
// unbiased if no n_k depends on what the rays of the group found.
#pragma once

#include <span>
#include <vector>

#include "tools/render/compensate/compensate.h"
#include "tools/render/tile/reuse/directions.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// A vertex on a surface that is diffuse, apart from a near-specular coat.
struct ReusedVertex {
  Vec3 position, normal;  // unit, on the side of the sample that found it
  ExitantFactor leaving;
  Vec3 radiance;  // radiance that leaves the vertex, over the factor of `leaving`, W/(m2 sr)
  UncoveredShare uncovered;
};

// A sample of the group.
struct ReusingSample {
  const Directions* directions;            // distribution of its rays
  unsigned rays;                           // number of rays that it sent, n_k
  std::span<const ReusedVertex> vertices;  // those that its rays found
  const Vec3* verticesByLightGroup;        // their radiance by light group; null: not told apart
  Vec3* radianceByLightGroup;              // result: `radiance` by light group
  Vec3 radiance = {};  // result: the light of all vertices of the group, W/(m2 sr)
  Vec3 squares = {};   // result: sum of their squared contributions, for the variance
};

// Fills in the results. `lightGroups`: number of light groups that are told apart. Returns the
// number of shadow rays.
size_t reuseVertices(const Accelerator& accel, std::span<ReusingSample> group,
                     uint32_t lightGroups = 0);

}  // namespace bnvpl
