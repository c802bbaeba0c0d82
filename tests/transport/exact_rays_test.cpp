// Accelerator for Processor::Any computes its own hits in Embree's traversal.
#include "core/random.h"
#include "core/random_streams.h"
#include "core/sampling.h"
#include "scene/builder/scene_builder.h"
#include "tests/scene/scene_files.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

using ExactRays = SceneFiles;

// Masks, slivers and coincident triangles: both give the same hits up to the last digits.
TEST_F(ExactRays, HitWhatEmbreeHits) {
  const Scene scene = loadScene(fs::path(BNVPL_SCENES) / "test/quirks.toml");
  ASSERT_LT(scene.maskedBegin, scene.worldEnd());
  const Accelerator embree(scene), exact(scene, Processor::Any);
  const float size = scene.bounds.diagonal();
  Rng rng(streamKey(3, RandomStream::Plot), 0);
  int found = 0, other = 0, differ = 0;
  std::vector<Segment> segments;
  for (int i = 0; i < 20000; ++i) {
    const float u = rng.next(), v = rng.next();
    const Vec3 at{rng.next(), rng.next(), rng.next()};
    const Vec3 from = scene.bounds.lower + scene.bounds.extent() * at, to = sampleSphere(u, v);
    SurfacePoint a, b;
    const bool met = embree.closestHit(from, to, a);
    segments.push_back({from, from + 0.3f * size * to});
    differ += embree.occludedToInfinity(from, to) != exact.occludedToInfinity(from, to);
    differ += embree.occluded(from, segments.back().to) != exact.occluded(from, segments.back().to);
    differ += met != exact.closestHit(from, to, b);
    if (!met || b.triangle == kNone) continue;
    ++found;
    other += a.triangle != b.triangle;  // triangles that meet or coincide
    EXPECT_NEAR(a.distance, b.distance, 1e-5f * size) << i;
    EXPECT_LT(length(a.position - b.position), 1e-5f * size) << i;
  }
  EXPECT_GT(found, 5000);
  EXPECT_LT(other, found / 100);
  EXPECT_LT(differ, 5);  // rays along an edge
  std::vector<uint8_t> hidden(segments.size());
  exact.occluded(segments, hidden);
  for (size_t i = 0; i < segments.size(); ++i)
    EXPECT_EQ(hidden[i] != 0, exact.occluded(segments[i].from, segments[i].to)) << i;
}

// The result does not depend on the order of the traversal.
TEST_F(ExactRays, TheFirstOfTrianglesAtOneDistanceIsHit) {
  const Scene scene =
      loadMesh(kSquareObj + "f 3 4 1 2\nf 2 3 4 1\nf 4 1 2 3\n", "newmtl paint\nKd 0.5 0.5 0.5\n");
  const Accelerator accel(scene, Processor::Any);
  Rng rng(streamKey(4, RandomStream::Plot), 0);
  for (int i = 0; i < 1000; ++i) {
    const float x = 2 * rng.next() - 1, y = 2 * rng.next() - 1;
    for (const float side : {1.0f, -1.0f}) {
      SurfacePoint hit;
      ASSERT_TRUE(accel.closestHit({x, y, 2 * side}, {0, 0, -side}, hit));
      EXPECT_LT(hit.triangle, 2u) << x << " " << y;
      EXPECT_EQ(hit.distance, 2.0f);
    }
  }
}

// A shadow ray is passed to Embree longer than it is; nothing beyond its end occludes it.
TEST_F(ExactRays, EndWhereTheyEnd) {
  const Scene scene = loadMesh(kSquareObj, "newmtl paint\nKd 0.5 0.5 0.5\n");
  const Accelerator accel(scene, Processor::Any);
  const Vec3 from{0.3f, 0.2f, 2};
  for (const float past : {0x1p-20f, -0x1p-20f}) {
    const Vec3 to{0.3f, 0.2f, -past};
    const std::array segments{Segment{from, to}, Segment{to, from}};
    std::array<uint8_t, 2> hidden{};
    accel.occluded(segments, hidden);
    EXPECT_EQ(accel.occluded(from, to), past > 0) << past;
    EXPECT_EQ(hidden[0] != 0, past > 0) << past;
    EXPECT_EQ(hidden[1] != 0, past > 0) << past;
  }
}

}  // namespace
}  // namespace bnvpl
