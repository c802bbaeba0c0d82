// The attenuation without singularity against sums over a disk, and against clamped points.
#include "transport/virtual_light/yuksel/yuksel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "transport/virtual_light/point/point.h"

namespace bnvpl {
namespace {

// The mean of 1/d^2 and the receiver's cosine over a disk that faces the receiver, in rings of
// equal area.
TEST(YukselLights, AreDisksOfPointsSeenFromAboveTheirMiddle) {
  constexpr int kRings = 20000;
  for (const double d : {0.02, 0.2, 0.7, 5.0}) {
    double sum = 0.0;
    for (int k = 0; k < kRings; ++k) {
      const double slant2 = d * d + (k + 0.5) / kRings;
      sum += d / (slant2 * std::sqrt(slant2)) / kRings;
    }
    const float own = 1.0f / YukselLight::boundedDistance2(static_cast<float>(d * d), 1.0f);
    EXPECT_NEAR(double{own} / sum, 1.0, 2e-3) << d;
  }
}

// A clamp has an edge where it begins; the attenuation has none, and no point is dimmer than a
// disk.
TEST(YukselLights, HaveNoEdge) {
  const auto bend = [](auto kind, float d) {  // change of the slope around d
    const auto light = [&](float at) { return 1.0f / kind.boundedDistance2(at * at, 1.0f); };
    constexpr float kStep = 0.01f;
    return std::abs(light(d + kStep) - 2.0f * light(d) + light(d - kStep)) / kStep;
  };
  EXPECT_GT(bend(PointLight{}, 1.0f), 1.5f);
  for (float d = 0.1f; d < 3.0f; d += 0.05f) EXPECT_LT(bend(YukselLight{}, d), 0.1f) << d;
}

}  // namespace
}  // namespace bnvpl
