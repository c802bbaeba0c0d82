// Path reuse (Bekaert, Sbert & Halton 2002): the vertices that near-field rays of one sample find
// light the other samples of its group as well, as virtual lights that last no longer than the
// group. A vertex can be reused where its radiance is known in all directions once it is known in
// one (RoughLeaving: diffuse, bare or below a near-specular coat). Finding that radiance takes many
// rays, connecting one more sample to the vertex takes one.
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
// L depends on the direction to x_j by a factor alone where y lies below a coat. A ray that meets a
// coated vertex may follow the coat instead; L is divided by the probability that it did not,
// which p_k leaves out. No vertex weighs more than it would with the rays of j alone. The estimator
// is unbiased if no n_k depends on what the rays of the group found.
#pragma once

#include <span>
#include <vector>

#include "tools/render/compensate/compensate.h"
#include "tools/render/tile/reuse/directions.h"
#include "transport/rays.h"

namespace bnvpl {

// A vertex on a surface that is diffuse, apart from a near-specular coat.
struct ReusedVertex {
  Vec3 position, normal;  // unit, on the side of the sample that found it
  RoughLeaving leaving;
  Vec3 radiance;  // that leaves the vertex, divided by the factor of `leaving`, W/(m2 sr)
  UncoveredShare uncovered;
};

// A sample of the group.
struct ReusingSample {
  const Directions* directions;            // how its rays were drawn
  unsigned rays;                           // number of rays that it sent, n_k
  std::span<const ReusedVertex> vertices;  // those that its rays found
  Vec3 radiance = {};  // result: the light of all vertices of the group, W/(m2 sr)
  Vec3 squares = {};   // result: sum of their squared contributions, for the variance
};

// Fills in the results. Returns the number of shadow rays.
size_t reuseVertices(const RayScene& rays, std::span<ReusingSample> group);

}  // namespace bnvpl
