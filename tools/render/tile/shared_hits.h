// What near-field rays of one sample find lights the other samples of its group as well (local
// virtual lights): points whose own light had to be found out, in gaps between VPLs or too close
// for what a VPL knows. Where such a surface is matt, bare or below a sharp coat, the light that
// leaves it is known in all directions once it is in one (RoughLeaving), and finding it out costs
// far more than asking who sees it.
//
// A group's rays are techniques of one multi-sample MIS (Veach 1997, section 9.2.2). Sample k sends
// n_k rays; seen from the hit y their density is
//
//   p_k(y) = pdf_k(x_k -> y) s_y(|x_k - y|) |cos_y| / |x_k - y|^2 V(x_k, y),
//
// where s_y is the share of its light that is missing, and the chance that it is found out. By the
// balance heuristic the light L of all hits reaches sample j as
//
//   sum over y:  f_j(x_j -> y) s_y(|x_j - y|) |cos_y| / |x_j - y|^2 V(x_j, y) L(y) / sum_k n_k
//   p_k(y).
//
// Below a coat L depends on the direction to x_j by a factor alone; and over one, where the ray may
// be taken by the gloss instead, L is over the chance that it was not, as p_k leaves that out.
// No hit weighs more than it would with the rays of j alone. The mean is right as long as no n_k
// depends on what the group's rays have found.
#pragma once

#include <span>
#include <vector>

#include "tools/render/compensate/compensate.h"
#include "tools/render/tile/directions.h"
#include "transport/rays.h"

namespace bnvpl {

// A point of a surface that is matt below whatever coat it has.
struct SharedHit {
  Vec3 position, normal;  // towards where it was seen from, unit
  RoughLeaving leaving;
  Vec3 radiance;  // that leaves there, over the factor of `leaving`, W/(m2 sr)
  OwnLight own;   // how much of it is missing elsewhere
};

// A sample of the group.
struct HitSharer {
  const Directions* directions;
  unsigned rays;                    // that it sent, all of them
  std::span<const SharedHit> hits;  // of these
  Vec3 brought = {};                // by the hits of all, W/(m2 sr)
  Vec3 squares = {};                // by each of them, squared: the variance, as they are few
};

// Fills in what each of them gets. Returns the number of shadow rays.
size_t shareHits(const RayScene& rays, std::span<HitSharer> group);

}  // namespace bnvpl
