// Expressions over textures, which materials evaluate.
#include "scene/textures/expression.h"

#include <gtest/gtest.h>

#include "scene/builder/scene_builder.h"

namespace bnvpl {
namespace {

// Two by one texels: left (255, 0, 51), alpha 102; right black, alpha 255.
Texture twoTexels() {
  Texture t;
  t.width = 2, t.height = 1;
  t.srgb = false;
  t.rgba = {255, 0, 51, 102, 0, 0, 0, 255};
  return t;
}

struct Expressions {
  std::vector<Texture> textures{twoTexels()};
  std::vector<TextureExpression> list;
  uint32_t add(const TextureExpression& e) {
    list.push_back(e);
    return uint32_t(list.size() - 1);
  }
  Vec3 at(uint32_t e, float u, float v = 0.5f) const {
    return TextureEvaluator(list, textures).at(e, u, v);
  }
};

void expectNear(Vec3 a, Vec3 b) {
  EXPECT_LT(length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

TEST(Expression, ImagesGiveChannels) {
  Expressions e;
  const auto of = [&](Channel c) { return e.at(e.add(imageExpression(0, c)), 0.25f); };
  expectNear(of(Channel::Rgb), {1, 0, 0.2f});
  expectNear(of(Channel::Red), Vec3(1));
  expectNear(of(Channel::Blue), Vec3(0.2f));
  expectNear(of(Channel::Alpha), Vec3(0.4f));
  expectNear(of(Channel::Mean), Vec3(0.4f));
}

// The lookups equal Texture::lookup, whose pixels are those of MTL's maps.
TEST(Expression, RepeatedImagesAreTextures) {
  Expressions e;
  const uint32_t image = e.add(imageExpression(0));
  for (const float u : {-3.3f, -0.1f, 0.0f, 0.4f, 0.99f, 7.2f})
    expectNear(e.at(image, u), e.textures[0].lookup(u, 0.5f));
}

TEST(Expression, WrapsAsAsked) {
  Expressions e;
  TextureExpression image = imageExpression(0, Channel::Red);
  const auto at = [&](Wrap wrap, float u) {
    image.wrapU = wrap;
    return e.at(e.add(image), u).x;
  };
  EXPECT_NEAR(at(Wrap::Repeat, 1.25f), 1.0f, 1e-5f);
  EXPECT_NEAR(at(Wrap::Mirror, 1.25f), 0.0f, 1e-5f);
  EXPECT_NEAR(at(Wrap::Mirror, -0.25f), 1.0f, 1e-5f);
  EXPECT_NEAR(at(Wrap::Clamp, 1.25f), 0.0f, 1e-5f);
  EXPECT_NEAR(at(Wrap::Clamp, -5.0f), 1.0f, 1e-5f);
  EXPECT_NEAR(at(Wrap::Black, -0.75f), 0.0f, 1e-5f);
  EXPECT_NEAR(at(Wrap::Black, 0.0f), 0.5f, 1e-5f);  // half way to black
}

// pbrt scales, then inverts, then clamps negative values to 0.
TEST(Expression, ScalesThenInverts) {
  Expressions e;
  TextureExpression image = imageExpression(0);
  image.value = Vec3(2);
  image.invert = true;
  expectNear(e.at(e.add(image), 0.25f), {0, 1, 0.6f});
}

TEST(Expression, TransformsCoordinates) {
  Expressions e;
  TextureExpression image = imageExpression(0, Channel::Red);
  image.uv = {0, 1, 0, 1, 0, 0};  // rotated
  const uint32_t turned = e.add(image);
  EXPECT_NEAR(e.at(turned, 0.5f, 0.25f).x, 1.0f, 1e-5f);
  EXPECT_NEAR(e.at(turned, 0.5f, 0.75f).x, 0.0f, 1e-5f);
}

TEST(Expression, CombinesOthers) {
  Expressions e;
  const uint32_t a = e.add(constantExpression({0.2f, 0.4f, 0.6f})),
                 b = e.add(constantExpression(Vec3(0.5f))),
                 quarter = e.add(constantExpression(Vec3(0.25f)));
  expectNear(e.at(e.add(productExpression(a, b)), 0), {0.1f, 0.2f, 0.3f});
  expectNear(e.at(e.add(mixExpression(a, b, quarter)), 0), {0.275f, 0.425f, 0.575f});
  const uint32_t board = e.add(checkerboardExpression(a, b, {2, 0, 0, 0, 2, 0}));
  expectNear(e.at(board, 0.1f, 0.1f), {0.2f, 0.4f, 0.6f});
  expectNear(e.at(board, 0.6f, 0.1f), Vec3(0.5f));
  expectNear(e.at(board, -0.1f, 0.1f), Vec3(0.5f));
  expectNear(e.at(board, 0.6f, 0.6f), {0.2f, 0.4f, 0.6f});
  expectNear(TextureEvaluator(e.list, e.textures).mean(board), {0.35f, 0.45f, 0.55f});
}

TEST(Expression, TakesAnyCoordinate) {
  Expressions e;
  const uint32_t image = e.add(imageExpression(0)),
                 board = e.add(checkerboardExpression(image, kNone, {1e30f, 0, 0, 0, 1, 0}));
  for (const float u : {1e38f, -1e38f, 3e9f, 1e-40f, NAN, INFINITY})
    EXPECT_TRUE(isFinite(e.at(board, u)) && isFinite(e.at(image, u))) << u;
}

// Each level evaluates the one below twice: 2^40 lookups, and as many mixes.
TEST(Expression, BuilderRefusesWhatTakesForEver) {
  SceneBuilder builder("a.toml");
  uint32_t e = builder.addExpression(constantExpression(Vec3(1))), m = builder.addMaterial({});
  for (int i = 0; i < 40; ++i) {
    e = builder.addExpression(productExpression(e, e));
    Material mix;
    mix.model = MixModel{m, m, 0.5f};
    m = builder.addMaterial(mix);
  }
  uint32_t paint = builder.addMaterial({});
  const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  builder.addMesh("a.obj", {corners, {}, {}, {{{0, 1, 2}, kNoCorners, kNoCorners, paint}}});
  const Scene scene = builder.finish();
  EXPECT_LT(scene.expressions.size(), 40u);
  EXPECT_GE(std::count_if(
                scene.materials.begin(), scene.materials.end(),
                [](const Material& x) { return std::holds_alternative<DiffuseModel>(x.model); }),
            1);
  EXPECT_GE(scene.warnings.size(), 2u);
}

}  // namespace
}  // namespace bnvpl
