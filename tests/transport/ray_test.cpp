#include "core/random.h"
#include "core/random_streams.h"
#include "core/sampling.h"
#include "tests/scene/scene_files.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

using Rays = SceneFiles;
const std::string kPaint = "newmtl paint\nKd 0.5 0.5 0.5\n";

TEST_F(Rays, HitsAreDescribedFromTheSideOfTheRay) {
  const Scene scene = loadMesh(kSquareObj, kPaint);
  const Accelerator accel(scene);
  for (const float side : {1.0f, -1.0f}) {
    SurfacePoint hit;
    ASSERT_TRUE(accel.closestHit({0.5f, -0.25f, 2 * side}, {0, 0, -side}, hit));
    EXPECT_LT(length(hit.position - Vec3(0.5f, -0.25f, 0)), 1e-6f);
    EXPECT_EQ(hit.ng, Vec3(0, 0, side));
    EXPECT_EQ(hit.ns, Vec3(0, 0, side));
    EXPECT_EQ(hit.wo, Vec3(0, 0, side));
    EXPECT_EQ(hit.front, side > 0);
    EXPECT_NEAR(hit.u, 0.75f, 1e-6f);
    EXPECT_NEAR(hit.v, 0.375f, 1e-6f);
    EXPECT_NEAR(hit.distance, 2.0f, 1e-6f);
  }
  SurfacePoint hit;
  EXPECT_FALSE(accel.closestHit({0, 0, 2}, {0, 0, 1}, hit));
  EXPECT_FALSE(accel.closestHit({1.5f, 0, 2}, {0, 0, -1}, hit));
}

// With normals, texture coordinates and a texture, batches prefetch all kinds of data.
TEST_F(Rays, ManyAtOnceAreWhatTheyAreOneByOne) {
  const Scene scene = loadScene(fs::path(BNVPL_SCENES) / "test/quirks.toml");
  const Accelerator accel(scene);
  Rng rng(streamKey(9, RandomStream::Plot), 0);
  std::array<Ray, Accelerator::kBatch> some;
  std::array<SurfacePoint, Accelerator::kBatch> hits;
  size_t found = 0, left = 0;
  for (size_t size = 0; size <= some.size(); ++size) {
    for (size_t i = 0; i < size; ++i) {
      const float u = rng.next(), v = rng.next();
      const Vec3 at{rng.next(), rng.next(), rng.next()};
      some[i] = {scene.bounds.lower + scene.bounds.extent() * at, sampleSphere(u, v)};
    }
    accel.closestHits({some.data(), size}, hits);
    for (size_t i = 0; i < size; ++i) {
      SurfacePoint alone;
      if (!accel.closestHit(some[i].origin, some[i].direction, alone)) {
        EXPECT_EQ(hits[i].triangle, kNone);
        ++left;
        continue;
      }
      ++found;
      EXPECT_EQ(hits[i].triangle, alone.triangle);
      EXPECT_EQ(hits[i].material, alone.material);
      EXPECT_EQ(hits[i].position, alone.position);
      EXPECT_EQ(hits[i].ng, alone.ng);
      EXPECT_EQ(hits[i].ns, alone.ns);
      EXPECT_EQ(hits[i].wo, alone.wo);
      EXPECT_EQ(hits[i].distance, alone.distance);
      EXPECT_EQ(hits[i].front, alone.front);
      EXPECT_TRUE(hits[i].u == alone.u || (std::isnan(hits[i].u) && std::isnan(alone.u)));
      EXPECT_TRUE(hits[i].v == alone.v || (std::isnan(hits[i].v) && std::isnan(alone.v)));
    }
  }
  EXPECT_GT(found, 10u);
  EXPECT_GT(left, 10u);
}

TEST_F(Rays, NoTextureCoordinatesAreNaN) {
  const Scene scene =
      loadMesh("mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n", kPaint);
  SurfacePoint hit;
  ASSERT_TRUE(Accelerator(scene).closestHit({0.2f, 0.2f, 1}, {0, 0, -1}, hit));
  EXPECT_TRUE(std::isnan(hit.u) && std::isnan(hit.v));
}

TEST_F(Rays, ShadingNormalIsInterpolatedAndFacesTheRay) {
  const Scene scene = loadMesh(
      "mtllib square.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 1\nvn 0 0 1\nf 1//1 2//2 "
      "3//2\n",
      kPaint);
  const Accelerator accel(scene);
  SurfacePoint hit;
  ASSERT_TRUE(accel.closestHit({0.1f, 0.1f, 1}, {0, 0, -1}, hit));
  EXPECT_GT(hit.ns.x, 0.1f);
  EXPECT_NEAR(length(hit.ns), 1.0f, 1e-6f);
  EXPECT_EQ(hit.ng, Vec3(0, 0, 1));
  ASSERT_TRUE(accel.closestHit({0.1f, 0.1f, -1}, {0, 0, 1}, hit));
  EXPECT_LT(hit.ns.z, 0.0f);
  EXPECT_EQ(hit.ng, Vec3(0, 0, -1));
}

// A random walk inside a closed box, near the origin and far from it. Only a hit exactly on an edge
// lies in both planes and can leave through the other one.
TEST_F(Rays, LiftedPointsStayOnTheirSide) {
  struct Place {
    const char* keys;
    int edgeHits;  // allowed: the float grid is coarse far from the origin
  };
  for (const auto& [keys, edgeHits] :
       {Place{"", 0}, Place{"scale = 0.001\n", 0}, Place{"translate = [1000, -2000, 3000]\n", 8}}) {
    const Scene scene = loadMesh(
        "mtllib square.mtl\nusemtl paint\nv -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\n"
        "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
        "f 1 3 7 5\nf 2 6 8 4\nf 1 5 6 2\nf 3 4 8 7\nf 1 2 4 3\nf 5 7 8 6\n",
        kPaint, keys);
    const Accelerator accel(scene);
    Rng rng(1, 0);
    const Vec3 center = scene.bounds.center(), start = normalize({0.3f, 0.5f, 0.7f});
    Vec3 origin = center, direction = start;
    int hidden = 0, escaped = 0;
    for (int i = 0; i < 20000; ++i) {
      SurfacePoint hit;
      if (!accel.closestHit(origin, direction, hit)) {
        ++escaped;
        origin = center;
        direction = start;
        continue;
      }
      origin = accel.offsetOrigin(hit.position, hit.ng);
      hidden += accel.occluded(origin, center) ? 1 : 0;
      const float u = rng.next(), v = rng.next();
      direction = Frame(hit.ng).toWorld(sampleCosineHemisphere(u, v));
    }
    EXPECT_LE(hidden, edgeHits) << keys;
    EXPECT_LE(escaped, edgeHits) << keys;
  }
}

TEST_F(Rays, OcclusionIsStrictlyBetween) {
  const Scene scene = loadMesh(kSquareObj, kPaint);
  const Accelerator accel(scene);
  EXPECT_TRUE(accel.occluded({0, 0.1f, 1}, {0, 0.1f, -1}));
  EXPECT_FALSE(accel.occluded({0, 0.1f, 1}, {0, 0.1f, 0.001f}));
  EXPECT_FALSE(accel.occluded({0, 0.1f, -0.001f}, {0, 0.1f, -1}));
  EXPECT_FALSE(accel.occluded({0, 0.1f, 1}, accel.offsetOrigin({0, 0.1f, 0}, {0, 0, 1})));
  EXPECT_TRUE(accel.occluded({0, 0.1f, 1}, accel.offsetOrigin({0, 0.1f, 0}, {0, 0, -1})));
}

// A room with a box and any number of rays, close together and scattered.
TEST_F(Rays, OcclusionOfManyIsWhatItIsOneByOne) {
  const Scene scene = loadScene(fs::path(BNVPL_SCENES) / "cornell/scene.toml");
  const Accelerator accel(scene);
  Rng rng(streamKey(10, RandomStream::Plot), 0);
  const auto somewhere = [&](float share, Vec3 about) {
    const Vec3 at{rng.next() - 0.5f, rng.next() - 0.5f, rng.next() - 0.5f};
    return about + share * (scene.bounds.extent() * at);
  };
  const Vec3 center = scene.bounds.center();
  std::array<int, 2> seen{};
  for (size_t size = 0; size <= 40; ++size) {
    const float share = size % 2 == 0 ? 0.9f : 0.05f;
    std::vector<Segment> segments;
    const Vec3 from = somewhere(0.9f, center), to = somewhere(0.9f, center);
    for (size_t i = 0; i < size; ++i) {
      segments.push_back({somewhere(share, size % 2 == 0 ? center : from),
                          somewhere(share, size % 2 == 0 ? center : to)});
    }
    std::vector<uint8_t> hidden(size, 7);
    accel.occluded(segments, hidden);
    for (size_t i = 0; i < size; ++i) {
      EXPECT_EQ(hidden[i], accel.occluded(segments[i].from, segments[i].to));
      ++seen[hidden[i] & 1u];
    }
  }
  EXPECT_GT(seen[0], 100);
  EXPECT_GT(seen[1], 100);
}

}  // namespace
}  // namespace bnvpl
