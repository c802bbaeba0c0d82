// Renderers whose expected images must be equal, pixel by pixel, or equal known images.
#include "core/sampling.h"
#include "tests/render/lit_rooms.h"
#include "tests/support/flat_image.h"
#include "tests/support/pipeline.h"
#include "tests/support/student_t.h"
#include "tests/support/z_test.h"
#include "transport/camera.h"

namespace bnvpl::test {
namespace {

// A scene of the project with a film of the given size.
Scene sceneOf(const std::string& name, uint32_t width, uint32_t height) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / name);
  scene.film = {width, height};
  return scene;
}
World worldOf(const std::string& name, uint32_t width, uint32_t height) {
  return World(sceneOf(name, width, height));
}

Render paths(const World& world, const Given& options) {
  return [&world, options](uint64_t seed) {
    return renderWithout(world, "path", with(options, {{"seed", typed(seed)}})).image;
  };
}
Render photons(const World& world, const Given& options) {
  return [&world, options](uint64_t seed) {
    return renderWithout(world, "light", with(options, {{"seed", typed(seed + 1000)}})).image;
  };
}
Render vpls(const World& world, const VplTable& lit, const Given& options) {
  const bool direct = std::ranges::count(options, Given::value_type{"only", "direct"}) > 0;
  return
      [&world, &lit, options = with(direct ? kPlainDirect : kPlainRender, options)](uint64_t seed) {
        return renderVpls(world, lit, with(options, {{"seed", typed(seed)}})).image;
      };
}
Render flat(const World& world, float value) {
  const int width = int(world.scene.film.width), height = int(world.scene.film.height);
  return [=](uint64_t) { return flatImage(width, height, value, value, value); };
}

// Every wall shines with radiance 1 and reflects half: 1 + 1/2 is direct, 1/4 + 1/8 + ... indirect.
TEST(SameExpectation, FurnaceIsKnownAtEveryPixel) {
  const World world = worldOf("furnace/scene.toml", 24, 16);
  const Given all{{"spp", "16"}, {"max-bounces", "64"}},
      indirect = with(all, {{"only", "indirect"}});
  const Given oneBounce = with(indirect, {{"max-bounces", "1"}});
  EXPECT_TRUE(sameExpectation(paths(world, all), flat(world, 2.0f)));
  EXPECT_TRUE(sameExpectation(paths(world, oneBounce), flat(world, 0.25f)));
  EXPECT_TRUE(sameExpectation(photons(world, indirect), flat(world, 0.5f)));
  EXPECT_TRUE(sameExpectation(photons(world, oneBounce), flat(world, 0.25f)));
  // Rays complement light samples, which have no variance near an edge of two area lights.
  const Given direct{
      {"spp", "16"}, {"only", "direct"}, {"compensate", "near-field"}, {"near-field-rays", "4"}};
  EXPECT_TRUE(sameExpectation(vpls(world, {}, direct), flat(world, 1.5f)));
}

// BSDF rays alone sample area light, sky and sun, beside a point light that none can hit.
TEST(SameExpectation, PathsWithAndWithoutLightSampling) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {12, 12};
  scene.lights.resize(3);
  scene.lights[0].type = LightType::Environment;
  scene.lights[0].emission = Vec3{1.0f};
  scene.lights[1].type = LightType::Directional;
  scene.lights[1].direction = normalize(Vec3{0.3f, -0.4f, -1});
  scene.lights[1].angularRadiusRad = 0.5f;
  scene.lights[1].emission = Vec3{1.0f};
  scene.lights[2].position = scene.bounds.center();
  scene.lights[2].emission = Vec3{0.01f};
  const World world(std::move(scene));
  EXPECT_TRUE(sameExpectation(paths(world, {{"spp", "64"}}),
                              paths(world, {{"spp", "256"}, {"light-sampling", "off"}})));
}

// Irradiance over radiance, at a point below, from a horizontal square of side 0.2 centred over the
// origin at height 1, computed from its outline (Lambert 1760).
double irradianceBelowSquare(Vec3 at) {
  const std::array<Vec3, 4> corners{
      {{-0.1f, 1, -0.1f}, {0.1f, 1, -0.1f}, {0.1f, 1, 0.1f}, {-0.1f, 1, 0.1f}}};
  double sum = 0.0;
  for (size_t k = 0; k < 4; ++k) {
    const Vec3 a = normalize(corners[k] - at), b = normalize(corners[(k + 1) % 4] - at);
    const Vec3 axis = normalize(cross(a, b));
    sum += std::acos(std::clamp(double{dot(a, b)}, -1.0, 1.0)) * double{axis.y};
  }
  return 0.5 * std::fabs(sum);
}

// Radiance of the pixels that see only the patch at height 0; 0 at all others.
Image twoPatchesByFormFactors(const Scene& scene) {
  Image image = flatImage(int(scene.film.width), int(scene.film.height), 0, 0, 0);
  constexpr int kAcross = 8;  // points per pixel along each axis
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    double sum = 0.0;
    bool inside = true;
    for (int k = 0; k < kAcross * kAcross && inside; ++k) {
      // The points span the pixel from border to border, so a pixel is inside only as a whole.
      const float u = float(k % kAcross) / (kAcross - 1), v = float(k / kAcross) / (kAcross - 1);
      const Vec3 d = cameraDirection(scene.camera, scene.film,
                                     (float(i % scene.film.width) + u) / float(scene.film.width),
                                     (float(i / scene.film.width) + v) / float(scene.film.height));
      const Vec3 at = scene.camera.position + d * (-scene.camera.position.y / d.y);
      inside = std::max(std::fabs(at.x), std::fabs(at.z)) < 0.1f;
      sum += irradianceBelowSquare(at) / (kAcross * kAcross);
    }
    const double radiance = 10.0 * 0.5 / double{kPi} * sum;  // Le = 10, rho = 0.5
    for (ImageChannel& c : image.channels) c.data[i] = inside ? float(radiance) : 0.0f;
  }
  return image;
}

TEST(SameExpectation, TwoPatchesAreKnownAtEveryPixel) {
  const World world = worldOf("test/two-patches.toml", 24, 24);
  const Image expected = twoPatchesByFormFactors(world.scene);
  const auto known = [&](uint64_t) { return expected; };
  const auto inside = [&](const Render& render) {
    return [&expected, render](uint64_t seed) {
      Image image = render(seed);
      for (ImageChannel& c : image.channels) {
        for (size_t i = 0; i < c.data.size(); ++i) {
          if (expected.channels[0].data[i] == 0.0f) c.data[i] = 0.0f;
        }
      }
      return image;
    };
  };
  const std::vector<float>& red = expected.channels[0].data;
  EXPECT_GT(std::count_if(red.begin(), red.end(), [](float v) { return v > 0.0f; }), 100);
  const ZTest few{.seeds = 16};
  EXPECT_TRUE(sameExpectation(inside(paths(world, {{"spp", "64"}})), known, few));
  const Given direct{{"spp", "64"}, {"only", "direct"}};
  EXPECT_TRUE(sameExpectation(inside(vpls(world, {}, direct)), known, few));
  const Given nearField = with(direct, {{"compensate", "near-field"}});
  EXPECT_TRUE(sameExpectation(inside(vpls(world, {}, nearField)), known, few));
}

TEST(SameExpectation, PathsAndPhotonsInTheCornellBox) {
  const World world = worldOf("cornell/scene.toml", 20, 20);
  for (const unsigned bounces : {1u, 32u}) {
    const Given indirect{{"only", "indirect"}, {"max-bounces", typed(bounces)}};
    EXPECT_TRUE(sameExpectation(paths(world, with(indirect, {{"spp", "20"}})),
                                photons(world, with(indirect, {{"spp", "4"}})), {.seeds = 64}))
        << bounces;
  }
}

// The green and the red wall get two models each time; light is scattered in both directions.
TEST(SameExpectation, PathsAndPhotonsOverEveryModel) {
  const auto ggx = [](float alpha) { return Roughness(Scalar(alpha), Roughness::Alpha::Same); };
  ConductorModel rough, sharp;
  rough.roughness = Roughness(Scalar(0.4f), Scalar(0.7f), Roughness::Alpha::Same);
  sharp.roughness = ggx(0.15f);
  CoatedDiffuseModel smoothCoat, roughCoat;
  smoothCoat.reflectance = Vec3(0.8f, 0.4f, 0.2f);
  roughCoat.roughness = ggx(0.35f);
  CoatedConductorModel varnished;
  varnished.roughness = ggx(0.4f);
  varnished.coatRoughness = ggx(0.1f);
  MetallicRoughnessModel gltf;
  gltf.baseColour = Vec3(0.3f, 0.7f, 0.9f);
  gltf.metallic = 0.4f;
  gltf.roughness = 0.7f;
  gltf.clearcoat = 0.5f;
  DielectricModel frosted;
  frosted.roughness = ggx(0.3f);
  const std::vector<std::pair<const char*, std::array<MaterialModel, 2>>> walls{
      {"conductors", {rough, sharp}},
      {"coated diffuse", {smoothCoat, roughCoat}},
      {"coated conductor, diffuse transmission", {varnished, DiffuseTransmissionModel{}}},
      {"glTF, frosted glass", {gltf, frosted}}};
  for (const auto& [name, models] : walls) {
    Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
    scene.film = {12, 12};
    for (Material& m : scene.materials) {
      if (m.name == "Green") m.model = models[0];
      if (m.name == "Red") m.model = models[1];
    }
    const World world(std::move(scene));
    const Given indirect{{"only", "indirect"}};
    EXPECT_TRUE(sameExpectation(paths(world, with(indirect, {{"spp", "64"}})),
                                photons(world, with(indirect, {{"spp", "32"}})), {.seeds = 16}))
        << name;
  }
}

// The walls' shading normals are tilted, so that views from every corner bend them (LobeFrame).
// Photons leave as radiance is seen, even from below the shading normal's horizon.
TEST(SameExpectation, PathsAndPhotonsOverNormalMaps) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {16, 16};
  addTextureCoordinates(scene);
  scene.expressions = {constantExpression(0.5f * normalize(Vec3{0.8f, 0.4f, 0.4f}) + Vec3(0.5f))};
  ConductorModel metal;
  metal.roughness = Roughness(Scalar(0.5f), Scalar(0.5f), Roughness::Alpha::Same);
  MetallicRoughnessModel gltf;
  gltf.baseColour = Vec3(0.7f);
  gltf.clearcoat = 0.5f;
  for (Material& m : scene.materials) {
    if (m.name == "Lamp") continue;
    m.model = m.name == "Red" ? MaterialModel(metal) : MaterialModel(gltf);
    m.relief.normalMap = 0;
  }
  const World world(std::move(scene));
  const Given indirect{{"only", "indirect"}};
  EXPECT_TRUE(sameExpectation(paths(world, with(indirect, {{"spp", "16"}})),
                              photons(world, with(indirect, {{"spp", "4"}})), {.seeds = 64}));
}

// Panels, one before the other, are instances of the same triangles: a photon at one is not seen
// through another.
TEST(SameExpectation, PathsAndPhotonsOnInstances) {
  SceneBuilder builder("panels");
  builder.setFilm({16, 12});
  Camera camera;
  camera.verticalFovRad = 0.8f;
  builder.setCamera({0, 0, 3}, camera);
  Material white, lamp;
  white.model = DiffuseModel{Vec3(0.7f)};
  lamp.emission = Vec3(4.0f);
  const uint32_t paint = builder.addMaterial(white);
  addQuad(builder, paint, {-2, -1, -2}, {0, 0, 8}, {4, 0, 0});  // floor
  addQuad(builder, paint, {-2, -1, -2}, {4, 0, 0}, {0, 3, 0});
  addQuad(builder, builder.addMaterial(lamp), {-1, 2, -1}, {2, 0, 0}, {0, 0, 3});
  const uint32_t panel = builder.beginPrototype();
  addQuad(builder, paint, {-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0});
  builder.endPrototype();
  for (const double z : {0.0, -0.5, -1.0})
    builder.addInstance(panel, Affine::fromParts({0, 0, z}, {0, 0, 0}, {1, 1, 1}));
  const World world(builder.finish());
  ASSERT_EQ(world.scene.instances.size(), 3u);
  const Given indirect{{"only", "indirect"}};
  EXPECT_TRUE(sameExpectation(paths(world, with(indirect, {{"spp", "16"}})),
                              photons(world, with(indirect, {{"spp", "4"}})), {.seeds = 64}));
}

// Two estimators of direct light: one light and one ray, and all lights with BSDF rays besides.
TEST(SameExpectation, DirectLightOfPathsAndOfVplsFromSeveralLights) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {28, 16};
  scene.lights.assign(2, LightSpec{});
  scene.lights[0].type = LightType::Environment;
  scene.lights[0].emission = Vec3{2.0f, 1.0f, 0.5f};
  scene.lights[1].position = {0.3f, 0.45f, 0.1f};
  scene.lights[1].emission = Vec3{0.1f};
  const World world(std::move(scene));
  const Given byVpls{
      {"spp", "16"}, {"only", "direct"}, {"compensate", "near-field"}, {"near-field-rays", "2"}};
  const Render byPaths = remembered(paths(world, {{"spp", "48"}, {"only", "direct"}}));
  EXPECT_TRUE(sameExpectation(byPaths, vpls(world, {}, byVpls)));
  // Without VPLs all light is direct. Its samples follow noise and cost, or are three.
  for (const char* count : {"0", "3"}) {
    const Given own{{"spp", "8"}, {"compensate", "none"}, {"direct-samples", count}};
    EXPECT_TRUE(sameExpectation(byPaths, vpls(world, {}, own))) << count;
  }
  // The same holds where only direct light is shown.
  const Given few{{"spp", "4"}, {"only", "direct"}, {"fireflies", "keep"}};
  for (const Given& more : {Given{}, Given{{"allocate", "off"}}, Given{{"direct-samples", "3"}}}) {
    EXPECT_TRUE(sameExpectation(byPaths, [&](uint64_t seed) {
      return renderVpls(world, {}, with(with(few, more), {{"seed", typed(seed)}})).image;
    })) << more.size();
  }
}

MaterialModel sharpMetal() {
  ConductorModel metal;
  metal.roughness = Roughness(Scalar(0.2f), Roughness::Alpha::Same);
  return metal;
}

// Plastic with a near-specular coat, and a wall of near-specular metal alone.
Scene coatedCornellBox() {
  Scene scene = sceneOf("cornell/scene.toml", 16, 12);
  for (Material& m : scene.materials) {
    if (m.name == "Lamp") continue;
    CoatedDiffuseModel coated;
    coated.reflectance = m.name == "Red" ? Vec3(0.7f, 0.2f, 0.1f) : Vec3(0.7f);
    coated.roughness = Roughness(Scalar(0.2f), Roughness::Alpha::Same);
    m.model = coated;
    if (m.name == "Green") m.model = sharpMetal();
  }
  return scene;
}

// Few VPLs leave uncovered areas and short rays. Allocated samples and rays reused by other
// receivers, also below a coat, must not change the expected image.
TEST(SameExpectation, SampleAllocationAndPathReuse) {
  const std::array scenes{sceneOf("cornell/scene.toml", 16, 12),
                          sceneOf("u-shape/scene.toml", 16, 12), coatedCornellBox()};
  for (const Scene& scene : scenes) {
    const World world(scene);
    const VplTable lit =
        litVpls(world, {{"count", "60"}}, {{"photons", "50k"}}, {{"count", "2000"}});
    const auto with4spp = [&](const char* allocate, const char* reuse) {
      return vpls(world, lit,
                  {{"spp", "4"},
                   {"gather", "tilecuts"},
                   {"compensate", "near-field"},
                   {"caustic-photons", "0"},
                   {"allocate", allocate},
                   {"reuse", reuse}});
    };
    const Render plain = remembered(with4spp("off", "1"));
    for (const char* allocate : {"off", "on"}) {
      for (const char* reuse : {"1", "8"}) {
        if (*reuse == '1' && std::string_view(allocate) == "off") continue;
        EXPECT_TRUE(sameExpectation(plain, with4spp(allocate, reuse), {.seeds = 48}))
            << &scene - scenes.data() << ", allocate " << allocate << ", reuse " << reuse;
      }
    }
  }
}

// Near-specular lobes sample lights from distributions learned by tiles and surfaces; the path
// tracer does not. Most of the power is the sky's, of which the box sees little.
TEST(SameExpectation, NearSpecularLobesAndLearnedLights) {
  Scene scene = coatedCornellBox();
  scene.lights.emplace_back().type = LightType::Environment;
  scene.lights.back().emission = Vec3{2.0f, 1.0f, 0.5f};
  Scene metal = scene;
  for (Material& m : metal.materials)
    if (m.name != "Lamp") m.model = sharpMetal();
  const World coated(std::move(scene)), allMetal(std::move(metal));
  const Given direct{{"only", "direct"}};
  EXPECT_TRUE(sameExpectation(paths(allMetal, with(direct, {{"spp", "32"}})),
                              vpls(allMetal, {}, with(direct, {{"spp", "8"}})), {.seeds = 64}));
  const VplTable lit = litVpls(coated);
  EXPECT_TRUE(sameExpectation(paths(coated, {{"spp", "64"}}), [&](uint64_t seed) {
    return renderVpls(coated, lit, {{"integrator", "guided"}, {"spp", "8"}, {"seed", typed(seed)}})
        .image;
  }));
}

TEST(SameExpectation, TileCutsAndAllVpls) {
  for (const char* name : {"cornell/scene.toml", "veach-door/scene.toml"}) {
    const World world = worldOf(name, 20, 15);
    const VplTable lit =
        litVpls(world, {{"count", "300"}}, {{"photons", "50k"}}, {{"count", "6000"}});
    const Given all{{"only", "indirect"}};
    const Given cuts = with(all, {{"gather", "tilecuts"}, {"error", "0.1"}, {"max-cut", "32"}});
    EXPECT_TRUE(sameExpectation(vpls(world, lit, cuts), vpls(world, lit, all))) << name;
  }
}

}  // namespace
}  // namespace bnvpl::test
