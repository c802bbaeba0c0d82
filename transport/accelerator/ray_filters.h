// Filter functions that Embree calls for each triangle that a ray may hit. Used by accelerator.cpp
// only.
//
// Embree divides by a reciprocal estimate whose precision depends on the processor, and with newer
// instruction sets runs code that contracts products and sums. In its SSE2 code everything else is
// plain IEEE arithmetic: building, the boxes of robust scenes, edge tests, and normals of hits.
// Processor::Any selects that code, lengthens rays by more than the error of the estimate, and lets
// these filters divide and decide. Among hits at equal distance, the lowest instance and triangle
// wins, in whatever order Embree reports them.
#pragma once

#include <cassert>
#include <cmath>
#include <tuple>

#include "transport/accelerator/alpha_mask.h"
#include "transport/accelerator/embree.h"

namespace bnvpl {

// User data of a geometry: its triangles are those of the scene from `begin` on.
struct FilteredTriangles {
  const Scene* scene;
  uint32_t begin;
};

// The state of a query. Embree passes its first member to the filters.
struct ExactQuery {
  QueryContext context;
  float reach;  // length of the ray, shortened by each hit that is kept
  uint32_t instance = kNone, triangle = kNone;
  float u = 0, v = 0;
};

// Lengthens a ray by more than the relative error of Embree's reciprocal, which is below 2^-21.
inline float beyond(float distance) { return distance * (1.0f + 0x1p-18f); }

inline void rejectCutAway(const RTCFilterFunctionNArguments* args) {
  const auto& of = *static_cast<const FilteredTriangles*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const uint32_t triangle = of.begin + RTCHitN_primID(args->hit, args->N, i);
    if (!passesAlphaTest(*of.scene, triangle, RTCHitN_u(args->hit, args->N, i),
                         RTCHitN_v(args->hit, args->N, i)))
      args->valid[i] = 0;
  }
}

struct ExactHit {
  uint32_t instance, triangle;
  float distance, u, v;
};

// The hit of the i-th ray, which Embree has found to pass between the edges. The distance is
// computed in Embree's order of terms, but with a true division.
inline ExactHit exactHit(const RTCFilterFunctionNArguments* args, unsigned i) {
  const unsigned n = args->N;
  const auto& of = *static_cast<const FilteredTriangles*>(args->geometryUserPtr);
  const uint32_t triangle = of.begin + RTCHitN_primID(args->hit, n, i);
  const auto& corners = of.scene->triangles[triangle].position;
  const Vec3 origin{RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i),
                    RTCRayN_org_z(args->ray, n, i)};
  const Vec3 direction{RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                       RTCRayN_dir_z(args->ray, n, i)};
  const Vec3 normal{RTCHitN_Ng_x(args->hit, n, i), RTCHitN_Ng_y(args->hit, n, i),
                    RTCHitN_Ng_z(args->hit, n, i)};
  const Vec3 p0 = of.scene->positions[corners[0]] - origin,
             p1 = of.scene->positions[corners[1]] - origin,
             p2 = of.scene->positions[corners[2]] - origin;
  const auto product = [](Vec3 a, Vec3 b) { return a.x * b.x + (a.y * b.y + a.z * b.z); };
  // Twice the volumes between the ray and each edge: Plücker coordinates.
  const float b1 = product(cross(p2 - p0, p2 + p0), direction),
              b2 = product(cross(p0 - p1, p0 + p1), direction),
              b0 = product(cross(p1 - p2, p1 + p2), direction);
  const float all = b1 + b2 + b0, distance = product(p0, normal) / product(normal, direction);
  // beyond() relies on this bound.
  [[maybe_unused]] const float estimated = RTCRayN_tfar(args->ray, n, i);
  assert(!(std::fabs(estimated - distance) > 0x1p-20f * std::fabs(distance)));
  return {RTCHitN_instID(args->hit, n, i, 0), triangle, distance,
          all == 0.0f ? 0.0f : std::min(b1 / all, 1.0f),
          all == 0.0f ? 0.0f : std::min(b2 / all, 1.0f)};
}

// Filter of traceClosest(): keeps the nearest hit in the ExactQuery.
template <bool kMasked>
void keepExact(const RTCFilterFunctionNArguments* args) {
  auto& query = *reinterpret_cast<ExactQuery*>(args->context);
  const ExactHit hit = exactHit(args, 0);
  const auto place = [](const auto& of, float distance) {
    return std::tuple(distance, of.instance, of.triangle);
  };
  // NaN distances, which are no hits, compare as false.
  const bool nearer = hit.distance >= 0.0f && hit.distance <= query.reach &&
                      place(hit, hit.distance) < place(query, query.reach);
  const auto& of = *static_cast<const FilteredTriangles*>(args->geometryUserPtr);
  if (!nearer || (kMasked && !passesAlphaTest(*of.scene, hit.triangle, hit.u, hit.v))) {
    args->valid[0] = 0;
    return;
  }
  query.instance = hit.instance, query.triangle = hit.triangle;
  query.u = hit.u, query.v = hit.v;
  query.reach = hit.distance;
  RTCRayN_tfar(args->ray, args->N, 0) = beyond(hit.distance);
}

// Filter of traceShadow() and traceShadows(): rejects hits beyond the ray's length.
template <bool kMasked>
void hideExact(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const ExactQuery*>(args->context);
  const auto& of = *static_cast<const FilteredTriangles*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const ExactHit hit = exactHit(args, i);
    const bool met = hit.distance >= 0.0f && hit.distance <= query.reach &&
                     (!kMasked || passesAlphaTest(*of.scene, hit.triangle, hit.u, hit.v));
    if (!met) args->valid[i] = 0;
  }
}

}  // namespace bnvpl
