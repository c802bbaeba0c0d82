#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

TEST(Clamp, WhatItRemovesIsReportedAndGivesTheUnclampedImage) {
  const World world("furnace/scene.toml");
  const VplTable lit = litVpls(world, {{"count", "300"}});
  const auto clampedAt = [&](const char* clamp) {
    return renderVpls(world, lit, with(kPlainRender, {{"clamp", clamp}})).stats;
  };
  const FilmStats loose = clampedAt("0.02"), tight = clampedAt("4");
  EXPECT_LT(tight.indirect, 0.95 * loose.indirect);
  EXPECT_NEAR(tight.indirect + tight.clamped, loose.indirect + loose.clamped,
              0.001 * loose.indirect);
}

}  // namespace
}  // namespace bnvpl::test
