#include "tools/inspect/contributions/contributions.h"

#include <numeric>

#include "scene/load_scene.h"
#include "tests/inspect/tiny_scene.h"
#include "tools/common/files/json_text.h"
#include "transport/camera.h"
#include "transport/virtual_light/virtual_light.h"

namespace bnvpl {
namespace {

// VPLs before the wall of the tiny scene, which shine on it.
VplTable litRows(uint64_t sceneHash) {
  VplTable table;
  table.stage = VplStage::Lit;
  table.position = {{-1, 0.5f, 2}, {1.5f, -0.5f, 1.5f}, {-1.5f, -1, 1}, {0, 0, -1}};
  table.normal = {{0, 0, -1}, {-0.6f, 0, -0.8f}, {0, 0, -1}, {0, 0, -1}};
  table.albedo.assign(4, Vec3(0.5f));
  table.id = {0, 1, 2, 3};
  table.radius.assign(4, 0.5f);
  table.flux = {{1, 1, 1}, {3, 2, 1}, {0.5f, 0.5f, 0.5f}, {9, 9, 9}};
  table.emitPosition = table.position;
  table.emitNormal = table.normal;
  table.sceneHash = sceneHash;
  return table;
}

class ContributionsTest : public InspectTest {
 protected:
  ContributionsTest() {
    writeTinyScene(at(""));
    scene_ = loadScene(at("tiny.toml"));
  }
  Contributions found(size_t perPixel) const {
    const Accelerator accel(scene_);
    const ContributionOptions options{.film = {16, 12}, .samplesPerAxis = 1, .perPixel = perPixel};
    return contributionsOf(accel, litRows(scene_.contentHash), options, {});
  }
  Scene scene_;
};

TEST_F(ContributionsTest, PixelsListTheirVplsStrongestFirst) {
  const Contributions all = found(64), few = found(2);
  ASSERT_EQ(all.pixels.size(), 16u * 12u);
  size_t lit = 0;
  for (size_t i = 0; i < all.pixels.size(); ++i) {
    const PixelContributions& pixel = all.pixels[i];
    EXPECT_TRUE(std::ranges::is_sorted(pixel.shares, std::greater<>()));
    EXPECT_EQ(std::ranges::count(pixel.rows, 3u), 0) << "it shines away from the wall";
    if (pixel.rows.empty()) continue;
    ++lit;
    EXPECT_NEAR(std::accumulate(pixel.shares.begin(), pixel.shares.end(), 0.0), 1.0, 1e-5);
    // A shorter list is the start of the longer.
    const size_t kept = std::min<size_t>(2, pixel.rows.size());
    ASSERT_EQ(few.pixels[i].rows.size(), kept);
    EXPECT_TRUE(
        std::equal(few.pixels[i].rows.begin(), few.pixels[i].rows.end(), pixel.rows.begin()));
    EXPECT_EQ(few.pixels[i].radiance, pixel.radiance);
  }
  EXPECT_GT(lit, 150u);
}

// The light of a pixel by the formula of the VPL, at the point that its ray meets.
TEST_F(ContributionsTest, SharesAreThoseOfTheLight) {
  const Accelerator accel(scene_);
  const VplTable table = litRows(scene_.contentHash);
  const VplLights vpls = makeVplLights(table, accel, 2.0f);
  const Contributions all = found(64);
  const Film film{16, 12};
  for (const size_t pixel : {17u, 70u, 100u, 150u}) {
    const float x = (static_cast<float>(pixel % 16) + 0.5f) / 16.0f;
    const float y = (static_cast<float>(pixel / 16) + 0.5f) / 12.0f;
    SurfacePoint hit;
    ASSERT_TRUE(
        accel.closestHit(scene_.camera.position, cameraDirection(scene_.camera, film, x, y), hit));
    const Bsdf bsdf(scene_, hit);
    std::vector<double> light(table.size());
    for (size_t i = 0; i < vpls.size(); ++i) {
      VplTransfer c;
      if (!unoccludedTransfer(vpls, i, bsdf, c) ||
          accel.occluded(accel.offsetOrigin(hit.position, hit.ng), vpls.position[i]))
        continue;
      const Vec3 radiance = c.transfer * vpls.intensity[i];
      light[vpls.row[i]] = double{radiance.x + radiance.y + radiance.z} / 3.0;
    }
    const double sum = std::accumulate(light.begin(), light.end(), 0.0);
    ASSERT_GT(sum, 0.0);
    EXPECT_NEAR(double{all.pixels[pixel].radiance}, sum, 1e-5 * sum);
    for (size_t k = 0; k < all.pixels[pixel].rows.size(); ++k) {
      EXPECT_NEAR(double{all.pixels[pixel].shares[k]}, light[all.pixels[pixel].rows[k]] / sum,
                  1e-5);
    }
  }
}

TEST_F(ContributionsTest, RowsHaveTheirMeanOverTheFilm) {
  const Contributions all = found(64);
  std::vector<double> sums(4);
  for (const PixelContributions& pixel : all.pixels) {
    for (size_t k = 0; k < pixel.rows.size(); ++k)
      sums[pixel.rows[k]] += double{pixel.shares[k]} * double{pixel.radiance};
  }
  for (size_t row = 0; row < sums.size(); ++row)
    EXPECT_NEAR(all.radiance[row], sums[row] / (16 * 12), 1e-5 * all.radiance[row]);
  EXPECT_EQ(all.radiance[3], 0.0);
}

TEST_F(ContributionsTest, TheFilmHasTheScenesShape) {
  EXPECT_EQ(contributionFilm({1600, 900}).height, 45u);
  EXPECT_EQ(contributionFilm({80, 60}).height, 60u);
  EXPECT_EQ(contributionFilm({16384, 1}).height, 1u);
}

}  // namespace
}  // namespace bnvpl
