#include "tools/inspect/plot/plot.h"

#include "scene/load_scene.h"
#include "tests/inspect/tiny_scene.h"
#include "transport/camera.h"

namespace bnvpl {
namespace {

class Plot : public InspectTest {
 protected:
  Plot() {
    writeTinyScene(at(""));
    scene_ = loadScene(at("tiny.toml"));
  }
  // Indices of the pixels that the dots changed.
  std::vector<size_t> changed(const Accelerator& accel, const std::vector<Dot>& dots,
                              float diameter) {
    Canvas canvas = shadeView(accel, 2);
    const std::vector<uint8_t> before = canvas.rgb8();
    canvas.paint(dots, diameter);
    const std::vector<uint8_t> after = canvas.rgb8();
    std::vector<size_t> pixels;
    for (size_t i = 0; i < canvas.pixels.size(); ++i) {
      if (!std::equal(&before[3 * i], &before[3 * i] + 3, &after[3 * i])) pixels.push_back(i);
    }
    return pixels;
  }
  Scene scene_;
};

TEST_F(Plot, DotsStandWhereTheRowsProject) {
  const Accelerator accel(scene_);
  PlotCounts counts;
  const VplTable table = tinyRows(scene_.contentHash);
  const std::vector<Dot> dots = visibleDots(table, accel, {}, counts);
  ASSERT_EQ(dots.size(), 1u);
  EXPECT_EQ(counts.drawn, 1u);
  EXPECT_EQ(counts.occluded, 1u);
  EXPECT_EQ(counts.facingAway, 1u);
  EXPECT_EQ(counts.outside, 1u);

  const RasterPoint film = projectToFilm(scene_.camera, scene_.film, table.position[0]);
  const float x = film.x * 80, y = film.y * 60;
  const std::vector<size_t> pixels = changed(accel, dots, 5.0f);
  ASSERT_FALSE(pixels.empty());
  bool centre = false;
  for (const size_t i : pixels) {
    const size_t column = i % 80, row = i / 80;
    const float px = static_cast<float>(column), py = static_cast<float>(row);
    centre |= static_cast<size_t>(x) == column && static_cast<size_t>(y) == row;
    EXPECT_LT(std::hypot(px + 0.5f - x, py + 0.5f - y), 3.1f);
  }
  EXPECT_TRUE(centre);
}

TEST_F(Plot, ShowBackDrawsRings) {
  const Accelerator accel(scene_);
  PlotCounts counts;
  PlotOptions options;
  options.showBack = true;
  const std::vector<Dot> dots = visibleDots(tinyRows(scene_.contentHash), accel, options, counts);
  ASSERT_EQ(dots.size(), 2u);
  EXPECT_FALSE(dots[0].hollow);
  EXPECT_TRUE(dots[1].hollow);
  const std::vector<size_t> ring = changed(accel, {dots[1]}, 9.0f);
  ASSERT_FALSE(ring.empty());
  const size_t centre = static_cast<size_t>(dots[1].y) * 80 + static_cast<size_t>(dots[1].x);
  EXPECT_EQ(std::count(ring.begin(), ring.end(), centre), 0);  // the ring is hollow
}

TEST_F(Plot, NearDotsCoverFarOnes) {
  Canvas canvas{9, 9, std::vector<Vec3>(81)};
  const Dot red{4.5f, 4.5f, 1.0f, {1, 0, 0}, false}, green{4.5f, 4.5f, 2.0f, {0, 1, 0}, false};
  canvas.paint({red, green}, 7.0f);
  EXPECT_EQ(canvas.pixels[40], (Vec3{1, 0, 0}));
  canvas.paint({green, red}, 7.0f);
  EXPECT_EQ(canvas.pixels[40], (Vec3{1, 0, 0}));
}

TEST_F(Plot, DotsAtTheEdgeAreCut) {
  Canvas canvas{4, 4, std::vector<Vec3>(16)};
  canvas.paint(
      {Dot{0, 0, 1, {1, 1, 1}, false}, Dot{4, 4, 1, {1, 1, 1}, false}, Dot{-90, 2, 1, {}, false}},
      5.0f);
  EXPECT_GT(canvas.pixels[0].x, 0.9f);
  EXPECT_GT(canvas.pixels[15].x, 0.9f);
}

TEST_F(Plot, ColoursNeedTheirColumn) {
  const Accelerator accel(scene_);
  PlotCounts counts;
  PlotOptions options;
  options.colour = DotColour::Flux;
  VplTable table = tinyRows(scene_.contentHash);
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { requireColours("a.vpl", table, options.colour); }),
               "a.vpl: its rows have no flux to colour by; name a file from vpl-estimate or a "
               "vpl-place --method that lights VPLs"));
  options.colour = DotColour::Radius;
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { requireColours("a.vpl", table, options.colour); }),
               "a.vpl: its rows have no radius to colour by; run vpl-eliminate"));

  table.stage = VplStage::Lit;
  table.radius = {1, 2, 3, 4};
  table.flux = {{2, 1, 0}, {0, 0.01f, 0}, {0.5f, 0, 0}, {0, 0, 0}};
  options.colour = DotColour::Flux;
  const Vec3 strongest = visibleDots(table, accel, options, counts).at(0).colour;
  table.flux[0] = {0, 0, 0.001f};
  const Vec3 weakest = visibleDots(table, accel, options, counts).at(0).colour;
  EXPECT_GT(luminance(strongest), 2.0f * luminance(weakest));
}

TEST_F(Plot, EmptyTable) {
  const Accelerator accel(scene_);
  PlotCounts counts;
  VplTable table;
  table.stage = VplStage::Eliminated;
  PlotOptions options;
  options.colour = DotColour::Radius;
  EXPECT_TRUE(visibleDots(table, accel, options, counts).empty());
}

}  // namespace
}  // namespace bnvpl
