#include "spatial/compatible_surface.h"

#include <gtest/gtest.h>

namespace bnvpl {
namespace {

const Vec3 kUp{0, 0, 1};

TEST(CompatibleSurface, NormalsSeparateAtTheLimit) {
  const auto tilted = [](float degrees) {
    const float a = degrees * 3.14159265f / 180.0f;
    return Vec3{std::sin(a), 0, std::cos(a)};
  };
  EXPECT_TRUE(compatibleSurfaces({}, kUp, {}, tilted(59), 1.0f));
  EXPECT_FALSE(compatibleSurfaces({}, kUp, {}, tilted(61), 1.0f));
  EXPECT_FALSE(compatibleSurfaces({}, kUp, {}, -kUp, 1.0f));  // the other side of a wall
}

TEST(CompatibleSurface, HeightOverEitherPlaneSeparatesThem) {
  EXPECT_TRUE(compatibleSurfaces({}, kUp, {5, 0, 0.1f}, kUp, 0.11f));
  EXPECT_FALSE(compatibleSurfaces({}, kUp, {5, 0, 0.1f}, kUp, 0.09f));
  EXPECT_FALSE(compatibleSurfaces({}, kUp, {5, 0, -0.1f}, kUp, 0.09f));
  // b lies in a's plane, but a does not lie in b's.
  const Vec3 slanted = normalize({0.5f, 0, 1});
  EXPECT_FALSE(compatibleSurfaces({}, kUp, {5, 0, 0}, slanted, 1.0f));
  EXPECT_FALSE(compatibleSurfaces({5, 0, 0}, slanted, {}, kUp, 1.0f));
}

}  // namespace
}  // namespace bnvpl
