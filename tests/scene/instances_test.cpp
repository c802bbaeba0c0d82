// Instances against copies of the same triangles, each stored at its place.
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/random_streams.h"
#include "core/sampling.h"
#include "scene/builder/scene_builder.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"

namespace bnvpl {
namespace {

// A tent of four faces with shading normals and texture coordinates, one of them cut away, and an
// area light on top.
struct Tent {
  std::vector<double> positions{-1, 0,   -1, 1, 0, -1, 1, 0, 1, -1, 0, 1,
                                0,  1.5, 0,  0, 2, 0,  1, 2, 0, 0,  2, 1};
  std::vector<double> normals{-1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1, 0, 1, 0};
  std::vector<double> uvs{0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5};
  uint32_t paint, holes, lamp;

  explicit Tent(SceneBuilder& builder) {
    Material m;
    m.phong().diffuse = Vec3(0.5f);
    paint = builder.addMaterial(m);
    m.opacity = 0.2f;
    holes = builder.addMaterial(m);
    Material shining;
    shining.emission = Vec3(2.0f);
    lamp = builder.addMaterial(shining);
  }
  Mesh mesh() const {
    Mesh made{positions, normals, uvs, {}};
    for (uint32_t k = 0; k < 4; ++k) {
      const std::array<uint32_t, 3> c{(k + 1) % 4, k, 4};
      made.triangles.push_back({c, c, c, k == 3 ? holes : paint});
    }
    made.triangles.push_back({{5, 6, 7}, kNoCorners, kNoCorners, lamp});
    return made;
  }
};

Affine turned(double angle, std::array<double, 3> scale, std::array<double, 3> place) {
  return Affine::fromParts(place, {0.3 * angle, angle, 0.1}, scale);
}
const std::vector<Affine> kPlaces{
    turned(0.0, {1, 1, 1}, {0, 0, 0}), turned(1.0, {2, 1, 0.5}, {6, 1, 0}),
    turned(2.5, {-1, 1, 1}, {0, 0, 7}), turned(4.0, {1, -3, -0.4}, {-6, 2, 3})};

void addFloor(SceneBuilder& builder, double away) {
  const std::vector<double> corners{away - 20, -1, -20, away + 20, -1, -20, away, -1, 20};
  builder.addMesh("floor", {corners, {}, {}, {{{0, 2, 1}, kNoCorners, kNoCorners, kNone}}});
}

uint32_t addPrototype(SceneBuilder& builder, Mesh mesh) {
  const uint32_t prototype = builder.beginPrototype();
  builder.addMesh("tent", std::move(mesh));
  builder.endPrototype();
  return prototype;
}

// `own`: how far the mesh lies from its own origin; its places bring it back.
Scene tents(bool shared, double away = 0.0, double own = 0.0) {
  SceneBuilder builder("tents");
  Tent tent(builder);
  addFloor(builder, away);
  std::vector<Affine> places = kPlaces;
  for (Affine& p : places) p.m[0][3] += away;
  if (shared) {
    for (size_t i = 0; i < tent.positions.size(); i += 3) tent.positions[i] += own;
    const Affine back = Affine::fromParts({-own, 0, 0}, {0, 0, 0}, {1, 1, 1});
    for (Affine& p : places) p = p * back;
    const uint32_t prototype = addPrototype(builder, tent.mesh());
    for (const Affine& p : places) builder.addInstance(prototype, p);
  } else {
    for (const Affine& p : places) builder.addMesh("tent", tent.mesh(), p);
  }
  return builder.finish();
}

void expectSameHits(const Scene& one, const Scene& other, float tolerance,
                    Processor processor = Processor::This) {
  const Accelerator a(one, processor), b(other);
  Rng rng(streamKey(8, 1u), 0);
  int hits = 0, occluded = 0;
  for (int i = 0; i < 20000; ++i) {
    const float u = rng.next(), v = rng.next(), s = rng.next(), t = rng.next();
    const Vec3 centre = 0.5f * (one.bounds.lower + one.bounds.upper);
    const Vec3 origin = centre + 9.0f * sampleSphere(u, v) + Vec3{0, 6, 0};
    const Vec3 direction = normalize(centre + 6.0f * (sampleSphere(s, t)) - origin);
    SurfacePoint p, q;
    const bool met = a.closestHit(origin, direction, p);
    ASSERT_EQ(met, b.closestHit(origin, direction, q)) << i;
    if (!met) continue;
    hits += p.material != 3;
    EXPECT_NEAR(p.distance, q.distance, tolerance) << i;
    EXPECT_LT(length(p.position - q.position), tolerance);
    EXPECT_LT(length(p.ng - q.ng), tolerance);
    EXPECT_LT(length(p.ns - q.ns), tolerance);
    EXPECT_EQ(p.front, q.front);
    EXPECT_EQ(p.material, q.material);
    if (p.u == p.u) {
      EXPECT_NEAR(p.u, q.u, tolerance);
    }
    const Vec3 to = origin + 12.0f * direction;
    occluded += a.occluded(origin, to);
    EXPECT_EQ(a.occluded(origin, to), b.occluded(origin, to));
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(occluded, 2000);
}

TEST(Instances, AreHitAsIfEachWereStored) { expectSameHits(tents(true), tents(false), 1e-4f); }

TEST(Instances, AreHitForAnyProcessorToo) {
  expectSameHits(tents(true), tents(false), 1e-4f, Processor::Any);
}

TEST(Instances, FarFromTheOriginToo) {
  const Scene shared = tents(true, 1e6);
  EXPECT_NE(shared.origin[0], 0.0);
  expectSameHits(shared, tents(false, 1e6), 1e-3f);
}

TEST(Instances, OfAMeshFarFromItsOriginToo) {
  expectSameHits(tents(true, 0.0, 1e6), tents(false), 1e-3f);
}

// Corners of small triangles far away round to each other in the coordinates of the scene.
TEST(Instances, HaveTheNormalsOfTheirPrototype) {
  SceneBuilder builder("tents");
  const Tent tent(builder);
  addFloor(builder, 0.0);
  const uint32_t prototype = addPrototype(builder, tent.mesh());
  const std::vector<Affine> places{turned(1.0, {1e-4, 1e-4, 1e-4}, {1000, 0, 0}),
                                   turned(1.0, {-1e-4, 1e-4, 1e-4}, {1000, 5, 0})};
  for (const Affine& p : places) builder.addInstance(prototype, p);
  const Scene scene = builder.finish();
  const Accelerator accel(scene);
  for (size_t i = 0; i < 2; ++i) {
    const FilePoint middle = places[i].point({0, 0.5, 0});
    const Vec3 towards = fromOrigin(middle, scene.origin);
    Rng rng(streamKey(9, 1u), i);
    size_t hits = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 direction = sampleSphere(rng.next(), rng.next());
      SurfacePoint hit;
      if (!accel.closestHit(towards - 0.01f * direction, direction, hit)) continue;
      if (hit.instance == kNone) continue;
      ++hits;
      const Triangle& t = scene.triangles[hit.triangle];
      const Vec3 own = cross(scene.positions[t.position[1]] - scene.positions[t.position[0]],
                             scene.positions[t.position[2]] - scene.positions[t.position[0]]);
      const Vec3 right = places[i].normal({double{own.x}, double{own.y}, double{own.z}});
      EXPECT_NEAR(std::fabs(dot(hit.ng, right)), 1.0f, 1e-4f);
    }
    EXPECT_GT(hits, 100u) << i;
  }
}

TEST(Instances, AreStoredOnce) {
  const Scene shared = tents(true), flat = tents(false);
  EXPECT_EQ(shared.instances.size(), kPlaces.size());
  ASSERT_EQ(shared.prototypes.size(), 1u);
  EXPECT_EQ(shared.prototypes[0].end - shared.prototypes[0].begin, 4u);
  EXPECT_EQ(flat.triangles.size() - shared.triangles.size(), 4 * (kPlaces.size() - 1));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LE(shared.bounds.lower[i], flat.bounds.lower[i] + 1e-5f);
    EXPECT_GE(shared.bounds.upper[i], flat.bounds.upper[i] - 1e-5f);
  }
}

TEST(Instances, EmitWhereTheyStand) {
  const Scene shared = tents(true), flat = tents(false);
  const Accelerator a(shared), b(flat);
  const LightSet lamps(a), same(b);
  ASSERT_EQ(lamps.size(), same.size());
  EXPECT_NEAR(lamps.totalPower().x, same.totalPower().x, 1e-4f * same.totalPower().x);
}

// A mesh of many vertices of which three emit is stored once, and these three in each place.
TEST(Instances, LampsAreStoredWithTheirOwnVerticesOnly) {
  SceneBuilder builder("lamps");
  Material lamp;
  lamp.emission = Vec3(1);
  const uint32_t shining = builder.addMaterial(lamp), dark = builder.addMaterial({});
  std::vector<double> positions;
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < 100; ++i) {
    positions.insert(positions.end(), {double(i), 0, 0, double(i) + 1, 0, 0, double(i), 1, 0});
    triangles.push_back(
        {{3 * i, 3 * i + 1, 3 * i + 2}, kNoCorners, kNoCorners, i ? dark : shining});
  }
  const uint32_t prototype = builder.beginPrototype();
  builder.addMesh("m.obj", {positions, {}, {}, triangles});
  builder.endPrototype();
  for (int k = 0; k < 50; ++k)
    builder.addInstance(prototype, turned(0.0, {1, 1, 1}, {0, 0, 2.0 * k}));
  const Scene scene = builder.finish();
  EXPECT_LT(scene.positions.size(), 300u + 50 * 3 + 10);
  const Accelerator accel(scene);
  EXPECT_NEAR(LightSet(accel).totalPower().x, 50 * 0.5f * kPi, 1e-3f);
}

TEST(Instances, TheHashKnowsWhereTheyStand) {
  const auto hashOf = [](double x) {
    SceneBuilder builder("tents");
    const Tent tent(builder);
    addFloor(builder, 0.0);
    const uint32_t prototype = addPrototype(builder, tent.mesh());
    builder.addInstance(prototype, turned(0.0, {1, 1, 1}, {x, 0, 0}));
    builder.addInstance(prototype, turned(0.0, {1, 1, 1}, {4, 0, 0}));
    return builder.finish().contentHash;
  };
  EXPECT_EQ(hashOf(1.0), hashOf(1.0));
  EXPECT_NE(hashOf(1.0), hashOf(1.5));
}

TEST(Instances, OneAloneIsStoredWhereItStands) {
  SceneBuilder builder("tents");
  const Tent tent(builder);
  const uint32_t prototype = addPrototype(builder, tent.mesh());
  builder.addInstance(prototype, kPlaces[1]);
  const Scene scene = builder.finish();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(scene.prototypes.empty());
  EXPECT_EQ(scene.triangles.size(), 5u);
}

TEST(Instances, WithoutVolumeAreLeftOut) {
  SceneBuilder builder("tents");
  const Tent tent(builder);
  addFloor(builder, 0.0);
  const uint32_t prototype = addPrototype(builder, tent.mesh());
  for (int i = 0; i < 2; ++i) builder.addInstance(prototype, turned(0.0, {1, 0, 1}, {0, 0, 0}));
  const Scene scene = builder.finish();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(scene.prototypes.empty());
}

}  // namespace
}  // namespace bnvpl
