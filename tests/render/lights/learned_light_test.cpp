// Direct light from learned distributions against one ray per light: equal means, less noise.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"

namespace bnvpl::test {
namespace {

const Given kDirect = with(kPlainDirect, {{"compensate", "near-field"}, {"near-field-rays", "2"}});

Render directBy(const World& world, const Given& options) {
  return [&world, options = with(kDirect, options)](uint64_t seed) {
    return renderVpls(world, {}, with(options, {{"seed", typed(seed)}})).image;
  };
}

TEST(LearnedLight, IsTheLightOfAllLights) {
  const World world(manyLights());
  EXPECT_TRUE(sameExpectation(directBy(world, {{"direct", "learned"}, {"spp", "8"}}),
                              directBy(world, {{"direct", "each"}, {"spp", "16"}})));
}

TEST(LearnedLight, FindsTheFewVisibleLights) {
  const World few(bulbs(0)), many(bulbs(1200));
  const Render learned = directBy(many, {{"direct", "learned"}}),
               each = directBy(many, {{"direct", "each"}});
  EXPECT_TRUE(sameExpectation(learned, directBy(few, {{"direct", "each"}})));
  EXPECT_LT(noiseOf(learned), 0.3 * noiseOf(each));
}

// The border of a visible area light is as smooth as with many rays.
TEST(LearnedLight, BordersOfVisibleEmissionHaveLessNoise) {
  Scene scene = room(32, 32);
  for (Material& m : scene.materials) {
    m.phong().diffuse = {};  // only visible emission remains
    if (!isBlack(m.emission)) m.twoSidedEmission = true;
  }
  const World world(std::move(scene));
  const Given few{{"spp", "4"}};
  const Render learned = directBy(world, with(few, {{"direct", "learned"}})),
               each = directBy(world, with(few, {{"direct", "each"}}));
  EXPECT_TRUE(sameExpectation(learned, each));
  EXPECT_LT(noiseOf(learned, 6, 1.0), 0.5 * noiseOf(each, 6, 1.0));  // few pixels have a border
}

}  // namespace
}  // namespace bnvpl::test
