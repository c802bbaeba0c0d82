#include "transport/accelerator/accelerator.h"

#include "core/prefetch.h"
#include "scene/visit_material.h"
#include "transport/accelerator/ray_filters.h"
#include "transport/bump_mapping.h"

#if defined(__SANITIZE_THREAD__)
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

namespace bnvpl {

namespace {

RTCRay makeRay(Vec3 origin, Vec3 direction, float tfar) {
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = tfar;
  ray.mask = ~0u;
  return ray;
}

}  // namespace

struct Accelerator::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;  // the world: opaque, masked, and instances from kFirstInstance on
  std::vector<RTCScene> prototypes;
  std::vector<std::unique_ptr<FilteredTriangles>> filtered;  // user data of the filters
  bool exact = false;                                        // Processor::Any
  // The first error of the device. Any thread may report it, also when out of memory: no
  // allocation.
  std::atomic<RTCError> error{RTC_ERROR_NONE};
  std::array<char, 256> errorText{};

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    for (const RTCScene prototype : prototypes) rtcReleaseScene(prototype);
    if (device) rtcReleaseDevice(device);
  }

  static void report(void* user, RTCError error, const char* text) {
    Impl& impl = *static_cast<Impl*>(user);
    RTCError none = RTC_ERROR_NONE;
    if (!impl.error.compare_exchange_strong(none, error) || !text) return;
    std::strncpy(impl.errorText.data(), text, impl.errorText.size() - 1);
  }
  void throwIfFailed() const {
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(std::string("Embree: ") + errorText.data());
  }

  static constexpr unsigned kOpaque = 0, kMasked = 1, kFirstInstance = 2;  // geometry ids

  RTCScene makeScene() {
    const RTCScene made = rtcNewScene(device);
    throwIfFailed();
    rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles
    return made;
  }
  void attach(RTCScene to, const Scene& s, uint32_t begin, uint32_t end, unsigned id) {
    if (begin == end) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               s.positions.data(), 0, sizeof(Vec3), s.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               s.triangles.data() + begin, 0, sizeof(Triangle), end - begin);
    if (exact || id == kMasked) {
      filtered.push_back(std::make_unique<FilteredTriangles>(FilteredTriangles{&s, begin}));
      rtcSetGeometryUserData(geometry, filtered.back().get());
      const RTCFilterFunctionN met = id == kMasked ? keepExact<true> : keepExact<false>,
                               hidden = id == kMasked ? hideExact<true> : hideExact<false>;
      rtcSetGeometryIntersectFilterFunction(geometry, exact ? met : rejectCutAway);
      rtcSetGeometryOccludedFilterFunction(geometry, exact ? hidden : rejectCutAway);
    }
    attach(to, geometry, id);
  }
  void attach(RTCScene to, RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to, geometry, id);
    rtcReleaseGeometry(geometry);
  }
  void commit(RTCScene made) {
#if defined(__SANITIZE_THREAD__)
    // Uses this thread alone: Embree is not compiled with the sanitizer, which would miss its
    // synchronisation of threads.
    tbb::task_arena(1).execute([&] { rtcCommitScene(made); });
#else
    rtcCommitScene(made);
#endif
    throwIfFailed();
  }
  void addInstances(const Scene& s) {
    for (const Prototype& p : s.prototypes) {
      prototypes.push_back(makeScene());
      attach(prototypes.back(), s, p.begin, p.maskedBegin, kOpaque);
      attach(prototypes.back(), s, p.maskedBegin, p.end, kMasked);
      commit(prototypes.back());
    }
    for (unsigned i = 0; i < s.instances.size(); ++i) {
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, prototypes[s.instances[i].prototype]);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                              s.instances[i].toWorld.data());
      attach(scene, geometry, kFirstInstance + i);
    }
  }

  bool closestHit(const Scene& s, const Ray& ray, SurfacePoint& hit) const;
  bool closestExactHit(const Ray& ray, SurfacePoint& hit) const;
  bool occluded(const RTCRay& from) const {
    RTCRay ray = from;
    ExactQuery query{{}, from.tfar};
    if (exact) ray.tfar = beyond(ray.tfar);
    traceShadow(scene, query.context, ray);
    return ray.tfar < 0.0f;
  }
};

Accelerator::Accelerator(const Scene& scene, Processor processor)
    : scene_(scene), impl_(std::make_unique<Impl>()) {
  impl_->exact = processor == Processor::Any;
  // Embree's hits differ with the processor's instruction set. The docs' examples choose one.
  impl_->device = rtcNewDevice(impl_->exact ? "isa=sse2,ignore_config_files=1"
                                            : std::getenv("BNVPL_EMBREE_CONFIG"));
  if (!impl_->device) {
    if (rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("Embree cannot start on this machine");
  }
  rtcSetDeviceErrorFunction(impl_->device, Impl::report, impl_.get());
  impl_->scene = impl_->makeScene();
  impl_->attach(impl_->scene, scene, 0, scene.maskedBegin, Impl::kOpaque);
  impl_->attach(impl_->scene, scene, scene.maskedBegin, scene.worldEnd(), Impl::kMasked);
  impl_->addInstances(scene);
  impl_->commit(impl_->scene);
  minRayOffset_ = scene.minRayOffset();
}

Accelerator::~Accelerator() = default;

// Sets triangle, instance, distance, and u and v to the barycentric coordinates.
bool Accelerator::Impl::closestHit(const Scene& s, const Ray& ray, SurfacePoint& hit) const {
  if (exact) return closestExactHit(ray, hit);
  RTCRayHit rh{};
  rh.ray = makeRay(ray.origin, ray.direction, std::numeric_limits<float>::infinity());
  rh.hit.geomID = rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  QueryContext context;
  traceClosest(scene, context, rh);
  if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    hit.triangle = kNone;
    return false;
  }
  const bool isMasked = rh.hit.geomID == kMasked;
  if (rh.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
    hit.instance = kNone;
    hit.triangle = rh.hit.primID + (isMasked ? s.maskedBegin : 0);
  } else {
    hit.instance = rh.hit.instID[0] - kFirstInstance;
    const Prototype& p = s.prototypes[s.instances[hit.instance].prototype];
    hit.triangle = rh.hit.primID + (isMasked ? p.maskedBegin : p.begin);
  }
  hit.distance = rh.ray.tfar;
  hit.u = rh.hit.u, hit.v = rh.hit.v;
  return true;
}

// The same, for Processor::Any.
bool Accelerator::Impl::closestExactHit(const Ray& ray, SurfacePoint& hit) const {
  RTCRayHit rh{};
  ExactQuery query{{}, std::numeric_limits<float>::infinity()};
  rh.ray = makeRay(ray.origin, ray.direction, query.reach);
  rh.hit.geomID = rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  traceClosest(scene, query.context, rh);
  hit.triangle = query.triangle;
  hit.instance = query.instance == kNone ? kNone : query.instance - kFirstInstance;
  hit.distance = query.reach;
  hit.u = query.u, hit.v = query.v;
  return hit.triangle != kNone;
}

// Completes a hit from its triangle, its distance, and the barycentric coordinates in u and v.
void Accelerator::describe(Vec3 direction, SurfacePoint& hit) const {
  const Triangle& t = scene_.triangles[hit.triangle];
  Vec3 p0 = scene_.positions[t.position[0]], p1 = scene_.positions[t.position[1]],
       p2 = scene_.positions[t.position[2]];
  // In the prototype's coordinates, edges have all their digits.
  Vec3 ng = cross(p1 - p0, p2 - p0);
  const Instance* instance = hit.instance == kNone ? nullptr : &scene_.instances[hit.instance];
  if (instance) p0 = instance->point(p0), p1 = instance->point(p1), p2 = instance->point(p2);
  const float b1 = hit.u, b2 = hit.v, b0 = 1.0f - b1 - b2;
  // Interpolating the corners is exact to a few ulps of the triangle, however long the ray is.
  hit.position = b0 * p0 + b1 * p1 + b2 * p2;
  hit.material = t.material;
  hit.wo = -direction;
  ng = normalize(instance ? instance->normal(ng) : ng);
  hit.front = dot(ng, hit.wo) >= 0.0f;
  hit.ng = hit.front ? ng : -ng;
  hit.ns = hit.ng;
  if (t.normal[0] != kNone && t.normal[1] != kNone && t.normal[2] != kNone) {
    Vec3 n0 = scene_.normals[t.normal[0]], n1 = scene_.normals[t.normal[1]],
         n2 = scene_.normals[t.normal[2]];
    if (instance) {
      n0 = normalize(instance->normal(n0)), n1 = normalize(instance->normal(n1));
      n2 = normalize(instance->normal(n2));
    }
    const Vec3 n = b0 * n0 + b1 * n1 + b2 * n2;
    const float len = length(n);
    if (len > 1e-6f) hit.ns = n * ((dot(n, hit.ng) < 0.0f ? -1.0f : 1.0f) / len);
  }
  hit.u = hit.v = std::numeric_limits<float>::quiet_NaN();
  hit.tangent = hit.coat = {};
  if (t.uv[0] != kNone && t.uv[1] != kNone && t.uv[2] != kNone) {
    const auto &a = scene_.uvs[t.uv[0]], &b = scene_.uvs[t.uv[1]], &c = scene_.uvs[t.uv[2]];
    hit.u = b0 * a[0] + b1 * b[0] + b2 * c[0];
    hit.v = b0 * a[1] + b1 * b[1] + b2 * c[1];
    applyRelief(scene_, t, hit);
  }
}

bool Accelerator::closestHit(Vec3 origin, Vec3 direction, SurfacePoint& hit) const {
  if (!impl_->closestHit(scene_, {origin, direction}, hit)) return false;
  describe(direction, hit);
  return true;
}

void Accelerator::closestHits(std::span<const Ray> rays, std::span<SurfacePoint> hits) const {
  for (size_t i = 0; i < rays.size(); ++i) {
    if (impl_->closestHit(scene_, rays[i], hits[i])) prefetch(&scene_.triangles[hits[i].triangle]);
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].triangle == kNone) continue;
    const Triangle& t = scene_.triangles[hits[i].triangle];
    for (size_t c = 0; c < 3; ++c) {
      prefetch(&scene_.positions[t.position[c]]);
      if (t.normal[c] != kNone) prefetch(&scene_.normals[t.normal[c]]);
      if (t.uv[c] != kNone) prefetch(&scene_.uvs[t.uv[c]]);
    }
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].triangle == kNone) continue;
    describe(rays[i].direction, hits[i]);
    forEachImage(scene_.materials[hits[i].material], [&](uint32_t image) {
      if (image != kNone) scene_.textures[image].prefetch(hits[i].u, hits[i].v);
    });
  }
}

bool Accelerator::occluded(Vec3 from, Vec3 to) const {
  return impl_->occluded(makeRay(from, to - from, 1.0f));
}

void Accelerator::occluded(std::span<const Segment> segments, std::span<uint8_t> hidden) const {
  constexpr size_t kTogether = 8;  // as wide as AVX
  for (size_t begin = 0; begin < segments.size(); begin += kTogether) {
    const size_t count = std::min(kTogether, segments.size() - begin);
    alignas(32) RTCRay8 rays;
    alignas(32) std::array<int, kTogether> valid;
    for (size_t k = 0; k < kTogether; ++k) {
      const Segment& s = segments[begin + std::min(k, count - 1)];
      valid[k] = k < count ? -1 : 0;
      rays.org_x[k] = s.from.x;
      rays.org_y[k] = s.from.y;
      rays.org_z[k] = s.from.z;
      rays.dir_x[k] = s.to.x - s.from.x;
      rays.dir_y[k] = s.to.y - s.from.y;
      rays.dir_z[k] = s.to.z - s.from.z;
      rays.tnear[k] = 0.0f;
      rays.tfar[k] = impl_->exact ? beyond(1.0f) : 1.0f;
      rays.time[k] = 0.0f;
      rays.mask[k] = ~0u;
      rays.id[k] = rays.flags[k] = 0;
    }
    ExactQuery query{{}, 1.0f};
    traceShadows(valid.data(), impl_->scene, query.context, rays);
    for (size_t k = 0; k < count; ++k) hidden[begin + k] = rays.tfar[k] < 0.0f;
  }
}

bool Accelerator::occludedToInfinity(Vec3 from, Vec3 direction) const {
  return impl_->occluded(makeRay(from, direction, std::numeric_limits<float>::infinity()));
}

}  // namespace bnvpl
