// The same room in other units and at other positions gives the same image.
#include "tests/numbers/room.h"

namespace bnvpl::test {
namespace {

using Units = RoomTest;

struct Images {
  Image vpl, path;
};

Images renderBoth(Scene scene) {
  const World world(std::move(scene));
  const VplTable lit =
      litVpls(world, {{"count", "200"}}, {{"photons", "40k"}}, {{"count", "4000"}});
  const RenderResult vpl = renderVpls(world, lit, {{"near-field-rays", "4"}, {"spp", "4"}});
  EXPECT_EQ(vpl.stats.nonFinite, 0u);
  const RenderResult path = renderWithout(world, "path", {{"spp", "16"}});
  EXPECT_EQ(path.stats.nonFinite, 0u);
  return {vpl.image, path.image};
}

// Root mean square difference over the mean of the first image.
double difference(const Image& a, const Image& b) {
  double squared = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    const std::vector<float>&x = *a.find(c), &y = *b.find(c);
    for (size_t i = 0; i < x.size(); ++i) squared += std::pow(double{x[i]} - double{y[i]}, 2);
  }
  return std::sqrt(squared / (3.0 * double(a.pixelCount()))) / meanOf(a);
}

bool sameBits(const Image& a, const Image& b) {
  return *a.find("R") == *b.find("R") && *a.find("G") == *b.find("G") &&
         *a.find("B") == *b.find("B");
}

// Scaling by a power of two does not change rounding. A difference would come from a constant that
// has the unit of a length, an area or a power.
TEST_F(Units, PowersOfTwoGiveTheSameBits) {
  const Images metres = renderBoth(room({"metres"}));
  for (const Placement& p : {Placement{"2^-10", 0x1p-10}, Placement{"2^13", 0x1p13}}) {
    const Images other = renderBoth(room(p));
    EXPECT_TRUE(sameBits(metres.vpl, other.vpl)) << p.name << difference(metres.vpl, other.vpl);
    EXPECT_TRUE(sameBits(metres.path, other.path)) << p.name << difference(metres.path, other.path);
  }
}

TEST_F(Units, OtherUnitsAndPlacesGiveTheSameImage) {
  const Images metres = renderBoth(room({"metres"}));
  for (const Placement& p :
       {Placement{"kilometres", 1e-3}, Placement{"0.1 mm", 1e4}, Placement{"1e5 away", 1.0, 1e5},
        Placement{"1e5 away in the OBJ", 1.0, 1e5, true},
        Placement{"kilometres, 1e5 away", 1e-3, 1e5, true}, Placement{"0.1 mm, 1e5 away", 1e4, 1e5},
        Placement{"10 sizes away", 1.0, 60.0}}) {
    const Images other = renderBoth(room(p));
    EXPECT_NEAR(meanOf(other.path) / meanOf(metres.path), 1.0, 0.003) << p.name;
    EXPECT_LT(difference(metres.path, other.path), 0.1) << p.name;
    // A weight that rounds differently changes which candidates are eliminated, and thus the VPLs.
    EXPECT_NEAR(meanOf(other.vpl) / meanOf(metres.vpl), 1.0, 0.015) << p.name;
    EXPECT_LT(difference(metres.vpl, other.vpl), 0.15) << p.name;
  }
}

// A face that covers nearly nothing takes no light, however far it extends.
TEST_F(Units, AFaceThatReachesFarAwayTakesNoLight) {
  const auto render = [&](const std::string& more, bool sky) {
    Scene scene = room({"room"}, more);
    if (!sky)
      scene.lights.resize(1);  // which are picked by power, and the sky's goes by the bounds
    return renderBoth(std::move(scene));
  };
  const Images alone = render("", false), underSky = render("", true);
  for (const char* corner : {"0 1e4 0", "2e6 1e6 -1e6", "-1e8 3e8 0"}) {
    const std::string face =
        std::string("v -1 2.6 -1.5\nv -0.9 2.6 -1.5\nv ") + corner + "\nusemtl white\nf -3 -2 -1\n";
    const Images far = render(face, false), farUnderSky = render(face, true);
    EXPECT_NEAR(meanOf(far.path) / meanOf(alone.path), 1.0, 0.005) << corner;
    EXPECT_NEAR(meanOf(far.vpl) / meanOf(alone.vpl), 1.0, 0.02) << corner;
    EXPECT_NEAR(meanOf(farUnderSky.path) / meanOf(underSky.path), 1.0, 0.05) << corner;
    EXPECT_NEAR(meanOf(farUnderSky.vpl) / meanOf(underSky.vpl), 1.0, 0.05) << corner;
  }
}

// Coordinates are stored relative to an origin of the scene's own only where the scene is far away.
TEST_F(Units, FarScenesHaveAnOriginOfTheirOwn) {
  EXPECT_EQ(room({"here"}).origin, FilePoint{});
  EXPECT_EQ(room({"10 sizes away", 1.0, 60.0}).origin, FilePoint{});
  const Scene far = room({"far", 1.0, 1e5});
  EXPECT_EQ(countContaining(far.warnings,
                            "scene.toml: lies far from its origin; coordinates count "
                            "from (100000, 100000, 100000)"),
            1u)
      << joined(far.warnings);
  EXPECT_EQ(far.contentHash, room({"here"}).contentHash);  // so VPLs of the one suit the other
}

// One case remains: a scene as large as its distance, such as a room with a stray triangle at the
// origin. Ray offsets grow with the coordinates, to 4 mm at a distance of 1000. Sky and sun are
// left out because their share of the shadow rays grows with the scene.
TEST_F(Units, AnOutlierAtTheOriginCoarsensWhatIsFarAway) {
  const auto render = [&](const Placement& p, const std::string& more) {
    Scene scene = room(p, more);
    scene.lights.resize(1);
    return renderBoth(std::move(scene));
  };
  const Images near = render({"here"}, "");
  for (const double distance : {100.0, 1000.0}) {
    const Images far = render({"far", 1.0, distance, true},
                              "v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\nusemtl white\nf -3 -2 -1\n");
    EXPECT_NEAR(meanOf(far.path) / meanOf(near.path), 1.0, 0.03) << distance;
    EXPECT_NEAR(meanOf(far.vpl) / meanOf(near.vpl), 1.0, 0.03) << distance;
  }
}

}  // namespace
}  // namespace bnvpl::test
