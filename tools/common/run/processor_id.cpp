#include "tools/common/run/processor_id.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/hash.h"
#include "core/random.h"
#include "tools/common/run/run_tool.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

// A height field of 2 * kSide^2 triangles, whose texture coordinates are the barycentric ones.
Scene field() {
  constexpr uint32_t kSide = 12, kCorners = kSide + 1;
  Scene scene;
  Rng rng(1, 0);
  for (uint32_t i = 0; i < kCorners * kCorners; ++i) {
    const auto x = static_cast<float>(i % kCorners), y = static_cast<float>(i / kCorners);
    const float dx = rng.next(), dy = rng.next();
    scene.positions.push_back({x + 0.4f * dx, y + 0.4f * dy, rng.next()});
    scene.bounds.extend(scene.positions.back());
  }
  scene.positions.push_back({});
  scene.uvs = {{0, 0}, {1, 0}, {0, 1}};
  scene.materials.resize(1);
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t a = y * kCorners + x, b = a + kCorners;
      for (const std::array<uint32_t, 3> corners : {std::array{a, a + 1, b}, {a + 1, b + 1, b}})
        scene.triangles.push_back({corners, {kNone, kNone, kNone}, {0, 1, 2}, 0});
    }
  }
  scene.maskedBegin = static_cast<uint32_t>(scene.triangles.size());
  return scene;
}

// Adds the hits of rays from above. Half of the rays aim at vertices, where triangles meet.
void addHits(Processor processor, std::vector<float>& bits) {
  constexpr uint32_t kRays = 1024;
  const Scene scene = field();
  const Accelerator accel(scene, processor);
  Rng rng(2, 0);
  const auto above = [&](float height) {
    const float x = rng.next(), y = rng.next();
    return Vec3{12.0f * x, 12.0f * y, height};
  };
  for (uint32_t i = 0; i < kRays; ++i) {
    const Vec3 from = above(4.0f), somewhere = above(0.5f);
    const Vec3 to = i % 2 == 0 ? somewhere : scene.corner(i % scene.maskedBegin, i % 3);
    SurfacePoint hit;
    const bool met = accel.closestHit(from, normalize(to - from), hit);
    bits.push_back(met ? static_cast<float>(hit.triangle) : -1.0f);
    if (met) bits.insert(bits.end(), {hit.distance, hit.u, hit.v});
  }
}

// Adds results of every C library function that the stages use and that may round differently.
template <typename Real>
void addFunctions(std::vector<Real>& bits) {
  constexpr uint32_t kArguments = 256;
  Rng rng(3, 0);
  for (uint32_t i = 0; i < kArguments; ++i) {
    const float high = rng.next(), low = rng.next(), other = rng.next();
    const Real x = Real(high) + Real(low) * Real(0x1p-24), y = Real(other);  // x uses all digits
    bits.insert(bits.end(), {std::sin(8 * x), std::cos(8 * x), std::tan(x), std::asin(x),
                             std::acos(x), std::atan(8 * x), std::atan2(x, y), std::exp(8 * x),
                             std::exp2(8 * x), std::expm1(x), std::log(x), std::log2(x),
                             std::log10(x), std::pow(x, 4 * y), std::cbrt(x), std::hypot(x, y)});
  }
}

}  // namespace

std::string processorId(Processor processor) {
  std::vector<float> floats;
  std::vector<double> doubles;
  addHits(processor, floats);
  addFunctions(floats);
  addFunctions(doubles);
  return hashText(
      hashPieces({std::as_bytes(std::span(floats)), std::as_bytes(std::span(doubles))}));
}

}  // namespace bnvpl
