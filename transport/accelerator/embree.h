// Embree 3 or 4, whichever CMake found. They differ in what is passed to a query beside its rays.
// Used by accelerator.cpp and ray_filters.h only.
#pragma once

#if BNVPL_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace bnvpl {

#if BNVPL_EMBREE_MAJOR >= 4

// What filters get of their query: the first member of ExactQuery.
using QueryContext = RTCRayQueryContext;

inline void traceClosest(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}

inline RTCOccludedArguments occludedArguments(QueryContext& context) {
  rtcInitRayQueryContext(&context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  return arguments;
}

inline void traceShadow(RTCScene scene, QueryContext& context, RTCRay& ray) {
  RTCOccludedArguments arguments = occludedArguments(context);
  rtcOccluded1(scene, &ray, &arguments);
}

inline void traceShadows(const int* valid, RTCScene scene, QueryContext& context, RTCRay8& rays) {
  RTCOccludedArguments arguments = occludedArguments(context);
  rtcOccluded8(valid, scene, &rays, &arguments);
}

#else

using QueryContext = RTCIntersectContext;

inline void traceClosest(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}

inline void traceShadow(RTCScene scene, QueryContext& context, RTCRay& ray) {
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

inline void traceShadows(const int* valid, RTCScene scene, QueryContext& context, RTCRay8& rays) {
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid, scene, &context, &rays);
}

#endif

}  // namespace bnvpl
