// Degenerate geometry, dark scenes and odd cameras: the image shows the rest of the scene, or the
// error names the problem.
#include "tests/numbers/room.h"

namespace bnvpl::test {
namespace {

class OddScenes : public RoomTest {
 protected:
  static VplTable fewVpls(const World& world, const char* candidates, const char* count) {
    return keepVpls(placeVpls(world, {{"count", candidates}}).table, {{"count", count}});
  }
  Image paths(Scene scene) const {
    const World world(std::move(scene));
    const RenderResult result = renderWithout(world, "path", {{"spp", "4"}, {"layers", "all"}});
    EXPECT_EQ(result.stats.nonFinite, 0u);
    return result.image;
  }
  static bool sameLight(const Image& a, const Image& b) {
    return *a.find("R") == *b.find("R") && *a.find("G") == *b.find("G") &&
           *a.find("B") == *b.find("B");
  }
  // The error of vpl-place for the scene; empty when it finds enough candidates.
  std::string placeError(const Scene& scene) const {
    const World world(scene);
    try {
      placeVpls(world, {{"count", "20"}});
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  std::string lightError(const Scene& scene) const {
    const World world(scene);
    const VplTable vpls = fewVpls(world, "50", "5");
    try {
      lightVpls(world, vpls, {{"photons", "100"}});
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  const Placement metres_{"metres"};
};

// Vertices that are missing, infinite or denormal; triangles without area; one triangle too small
// and one too large for a normal in floats.
TEST_F(OddScenes, UnusableTrianglesAreLeftOutAndCounted) {
  const Scene whole = room(metres_);
  const Scene odd = room(metres_,
                         "v 0 0 0\nv 1 0 0\nv 1e400 0 0\nv -1e999 1 1\nv 1e39 0 0\n"
                         "v 1e-40 0 0\nv 0 1e-42 0\nv 0 0 1e-45\nv 1e-12 0 0\nv 0 1e-12 0\n"
                         "usemtl white\n"
                         "f -10 -9 -8\nf -10 -9 -7\n"   // infinite
                         "f -10 -9 -9\nf -10 -9 -10\n"  // no area
                         "f -5 -4 -3\n"                 // denormal: no area in floats
                         "f -10 -2 -1\n");              // normal underflows
  EXPECT_EQ(odd.triangles.size(), whole.triangles.size());
  EXPECT_EQ(countContaining(odd.warnings, "2 triangles with missing or non-finite vertices"), 1u)
      << joined(odd.warnings);
  EXPECT_EQ(countContaining(odd.warnings, "triangles without area are left out"), 1u)
      << joined(odd.warnings);
  EXPECT_TRUE(sameLight(paths(whole), paths(odd)));
}

TEST_F(OddScenes, WordsInPlaceOfNumbersAreNamedWithTheirLine) {
  for (const char* vertex : {"v nan 0 0", "v 0 inf 0", "v 0 0 -nan"}) {
    const Scene whole = room(metres_);
    const Scene odd =
        room(metres_, std::string(vertex) + "\nv 0.5 0 0\nv 0 0.5 0\nusemtl white\nf -3 -2 -1\n");
    EXPECT_EQ(odd.triangles.size(), whole.triangles.size()) << vertex;
    EXPECT_EQ(countContaining(odd.warnings, "1 triangles with missing or non-finite vertices"), 1u)
        << vertex << "\n"
        << joined(odd.warnings);
  }
  for (const char* vertex : {"v 1,5 0 0", "v 0 zero 0"})
    EXPECT_THROW(room(metres_, std::string(vertex) + "\n"), InputError) << vertex;
}

// Each face exists twice: a ray hits one of them, and an area light does not emit twice.
TEST_F(OddScenes, DuplicateTrianglesChangeNothing) {
  const Scene whole = room(metres_);
  // Absolute indices make the copies name the same vertices.
  std::ifstream lines(at("room.obj"));
  std::string faces;
  int vertices = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("v ")) ++vertices;
    if (line.starts_with("usemtl")) faces += line + "\n";
    if (!line.starts_with("f ")) continue;
    std::istringstream words(line.substr(2));
    faces += "f";
    for (int index; words >> index;) faces += " " + std::to_string(vertices + 1 + index);
    faces += "\n";
  }
  const Scene twice = room(metres_, faces);
  EXPECT_EQ(twice.triangles.size(), 2 * whole.triangles.size() - 2);
  EXPECT_EQ(countContaining(twice.warnings, "2 emissive triangles lie on others"), 1u)
      << joined(twice.warnings);
  const Image once = paths(whole), doubled = paths(twice);
  EXPECT_NEAR(meanOf(doubled) / meanOf(once), 1.0, 1e-3);
}

// Which of two coincident surfaces a ray hits is undefined, but equal in every run.
TEST_F(OddScenes, CoincidentSurfacesOfDifferentMaterials) {
  const std::string carpet =
      "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nusemtl red\nf -4 -3 -2 -1\nusemtl lamp\nf -4 -3 "
      "-2\n";
  const Image first = paths(room(metres_, carpet)), second = paths(room(metres_, carpet));
  EXPECT_TRUE(sameLight(first, second));
  EXPECT_GT(meanOf(first), 0.0);
  const World world(room(metres_, carpet));
  const VplTable lit = lightVpls(world, fewVpls(world, "1000", "50"), {{"photons", "10k"}}).table;
  EXPECT_EQ(renderVpls(world, lit, {{"spp", "1"}}).stats.nonFinite, 0u);
}

// Another program may have lit the VPLs, by lights that it knows alone.
TEST_F(OddScenes, VplsMayBeAllTheLight) {
  const World bright(room(metres_, ""));
  const VplTable lit = lightVpls(bright, fewVpls(bright, "1000", "50"), {{"photons", "10k"}}).table;
  Scene scene = room(metres_, "");
  for (Material& m : scene.materials) m.emission = {};
  scene.lights.clear();
  const World dark(std::move(scene));
  ASSERT_EQ(dark.lights.size(), 0u);
  for (const char* integrator : {"vpl", "guided"}) {
    const FilmStats stats =
        renderVpls(dark, lit, {{"integrator", integrator}, {"spp", "2"}, {"fireflies", "keep"}})
            .stats;
    EXPECT_EQ(stats.direct, 0.0) << integrator;
    EXPECT_EQ(stats.nonFinite, 0u);
    if (std::string(integrator) == "vpl") {
      EXPECT_GT(stats.indirect, 0.0);
    }
  }
}

TEST_F(OddScenes, ALightOfNoPowerBesideOthersIsNotThere) {
  const std::string dark =
      "[[light]]\ntype = \"point\"\nposition = [0, 1, 0]\nintensity = [0, 0, 0]\n"
      "[[light]]\ntype = \"environment\"\nradiance = [1, 1, 1]\nscale = 0\n"
      "[[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\nirradiance = [0, 0, 0]\n";
  const std::string lit =
      "[[light]]\ntype = \"point\"\nposition = [0, 0, 2]\nintensity = [1, 1, 1]\n";
  const auto flux = [&](const std::string& lights) {
    World world(
        loadMesh(kSquareObj + "v -1 -1 2\nv -1 1 2\nv -1 1 0\nv -1 -1 0\nf -4/1 -3/2 -2/3 -1/4\n",
                 "newmtl paint\nKd 0.5 0.5 0.5\n", "", lights));
    return lightVpls(world, fewVpls(world, "200", "20"), {{"photons", "5000"}}).energy.reflected;
  };
  EXPECT_NEAR(flux(lit + dark) / flux(lit), 1.0, 0.05);
  EXPECT_GT(flux(lit), 0.0);
}

TEST_F(OddScenes, LightsWithoutPowerAloneAreRefusedByName) {
  Scene scene = room(metres_);
  for (LightSpec& l : scene.lights) l.emission = {};
  for (Material& m : scene.materials) m.emission = {};
  EXPECT_NE(lightError(scene).find("scene.toml: has no light with power"), std::string::npos)
      << lightError(scene);
}

TEST_F(OddScenes, LightsBeyondFloatsAreRefusedByName) {
  Scene scene = room(metres_);
  for (Material& m : scene.materials) {
    if (m.name == "lamp") m.emission = Vec3(3e38f);
  }
  try {
    const World world(scene);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("power of the emissive material 'lamp'"),
              std::string::npos)
        << e.what();
  }
}

// Light whose floats are denormal still adds up.
TEST_F(OddScenes, FaintLight) {
  Scene scene = room(metres_);
  for (LightSpec& l : scene.lights) l.emission *= 1e-34f;
  for (Material& m : scene.materials) m.emission *= 1e-34f;
  const World bright(room(metres_)), faint(scene);
  const VplTable vpls = fewVpls(bright, "200", "20");
  const EnergyAccount strong = lightVpls(bright, vpls, {{"photons", "2000"}}).energy;
  const EnergyAccount weak = lightVpls(faint, vpls, {{"photons", "2000"}}).energy;
  EXPECT_NEAR(weak.reflected * 1e34 / strong.reflected, 1.0, 0.01);
  EXPECT_EQ(weak.nonFinite, 0u);
}

TEST_F(OddScenes, BlackSurfaces) {
  Scene scene = room(metres_);
  for (Material& m : scene.materials) {
    PhongModel& p = m.phong();
    p.diffuse = p.glossy = p.mirror = p.transmission = {};
  }
  const std::string error = placeError(scene);
  EXPECT_NE(error.find("scene.toml: only 0 of 20 VPLs"), std::string::npos) << error;
  EXPECT_NE(error.find("met surfaces that reflect nothing"), std::string::npos) << error;
  paths(scene);
}

TEST_F(OddScenes, ACameraInsideAWall) {
  for (const Vec3 position : {Vec3(-0.7f, 0.3f, -0.9f),     // inside the box
                              Vec3(-2.0f, 1.0f, 0.5f),      // in the plane of a wall
                              Vec3(-2.0f, 0.0f, -2.0f)}) {  // in a corner
    Scene scene = room(metres_);
    scene.camera.position = position;
    paths(scene);
    const std::string error = placeError(scene);
    EXPECT_TRUE(error.empty() || error.find("scene.toml: only") != std::string::npos) << error;
  }
}

TEST_F(OddScenes, AViewOfNothingButSky) {
  Scene scene = room(metres_);
  scene.camera.position = {0.0f, 1.0f, 50.0f};
  scene.camera.forward = {0, 0, 1};
  scene.camera.right = {-1, 0, 0};
  scene.lights.pop_back();  // the sun, which is visible
  const std::string error = placeError(scene);
  EXPECT_NE(error.find("scene.toml: only 0 of 20 VPLs"), std::string::npos) << error;
  EXPECT_NE(error.find("100 % left the scene"), std::string::npos) << error;
  EXPECT_NE(error.find("point the camera at"), std::string::npos) << error;
  const Image sky = paths(scene);
  for (const float v : *sky.find("B")) EXPECT_FLOAT_EQ(v, 0.8f);
  for (const float z : *sky.find("Z")) EXPECT_EQ(z, INFINITY);
  scene.lights.clear();
  EXPECT_EQ(meanOf(paths(scene)), 0.0);  // nothing is hit
}

TEST_F(OddScenes, SizesBeyondFloatsAreRefused) {
  for (const double scale : {1e-8, 1e9}) {
    try {
      room({"", scale});
      ADD_FAILURE() << scale;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("units across"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace bnvpl::test
