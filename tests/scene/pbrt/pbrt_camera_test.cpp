// Film and camera: known points project onto known pixels, with the right orientation.
#include "tests/scene/pbrt/pbrt_files.h"
#include "transport/camera.h"

namespace bnvpl {
namespace {

class PbrtCamera : public PbrtFiles {
 protected:
  Scene view(const std::string& before, const std::string& film = "200 100") const {
    const size_t blank = film.find(' ');
    return loadPbrt("Film \"rgb\" \"integer xresolution\" " + film.substr(0, blank) +
                    " \"integer yresolution\"" + film.substr(blank) + "\n" + before +
                    "\nWorldBegin\n" + kSquareShape);
  }
  static RasterPoint pixel(const Scene& s, Vec3 p) {
    RasterPoint f = projectToFilm(s.camera, s.film, p);
    f.x *= float(s.film.width);
    f.y *= float(s.film.height);
    return f;
  }
};

// pbrt is left-handed: a camera that looks along +z with +y up has +x to the right.
TEST_F(PbrtCamera, LooksAlongZWithXToTheRight) {
  const Scene s = view("LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 90");
  EXPECT_EQ(s.film.width, 200u);
  expectNear(s.camera.position, {0, 0, -5}, 1e-5f);
  const RasterPoint right = pixel(s, {5, 0, 0}), up = pixel(s, {0, 5, 0});
  // The field of view spans the shorter side: 90 degrees reach 50 pixels up.
  EXPECT_NEAR(right.x, 150.0f, 0.01f);
  EXPECT_NEAR(right.y, 50.0f, 0.01f);
  EXPECT_NEAR(up.x, 100.0f, 0.01f);
  EXPECT_NEAR(up.y, 0.0f, 0.01f);
  EXPECT_NEAR(up.depth, 5.0f, 1e-5f);
}

TEST_F(PbrtCamera, ScaleMirrorsTheImage) {
  const Scene s =
      view("Scale -1 1 1 LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 90");
  EXPECT_NEAR(pixel(s, {5, 0, 0}).x, 50.0f, 0.01f);
  EXPECT_NEAR(pixel(s, {0, 5, 0}).y, 0.0f, 0.01f);
}

// The same camera as a matrix, the form that converters write.
TEST_F(PbrtCamera, Matrices) {
  const Scene s = view("Transform [-1 0 0 0  0 1 0 0  0 0 -1 0  0 0 5 1] Camera \"perspective\"");
  expectNear(s.camera.position, {0, 0, 5}, 1e-5f);
  expectNear(s.camera.forward, {0, 0, -1}, 1e-6f);
  expectNear(s.camera.right, {-1, 0, 0}, 1e-6f);
  expectNear(s.camera.up, {0, 1, 0}, 1e-6f);
}

TEST_F(PbrtCamera, FieldOfView) {
  const auto degrees = [](const Scene& s) { return s.camera.verticalFovRad * 57.2957795f; };
  const std::string camera = "Camera \"perspective\" \"float fov\" 60";
  EXPECT_NEAR(degrees(view(camera)), 60.0f, 1e-3f);
  // On a film that is higher than wide, the field of view is horizontal.
  const Scene tall = view(camera, "100 200");
  EXPECT_NEAR(std::tan(tall.camera.verticalFovRad / 2), 2.0 * std::tan(0.5235988), 1e-4);
  const Scene window = view(camera + " \"float screenwindow\" [-1 1 -0.5 0.5]");
  EXPECT_NEAR(std::tan(window.camera.verticalFovRad / 2), 0.5 * std::tan(0.5235988), 1e-4);
  const Scene wide = view(camera + " \"float frameaspectratio\" 1");
  EXPECT_EQ(countContaining(wide.warnings, "aspect"), 1u);
  EXPECT_NEAR(degrees(view("Camera \"perspective\" \"float halffov\" 20")), 40.0f, 1e-3f);
}

// Pixel (x, y) of a crop has the direction of pixel (x + left, y + top) of the whole film.
TEST_F(PbrtCamera, CropsArePartOfTheFilm) {
  const std::string camera = "Camera \"perspective\" \"float fov\" 60\n";
  const std::string film = "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 80 ";
  const Scene whole = view(camera + film);
  for (const char* crop :
       {"\"float cropwindow\" [0.1 0.5 0.25 0.75]", "\"integer pixelbounds\" [10 50 20 60]",
        "\"float cropwindow\" [0.1 0.5 0.25 0.75] \"integer pixelbounds\" [0 99 0 79]"}) {
    const Scene s = view(camera + film + crop);
    ASSERT_EQ(s.film.width, 40u);
    ASSERT_EQ(s.film.height, 40u);
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {40.0f, 40.0f}, {13.5f, 31.5f}}) {
      const Vec3 part = cameraDirection(s.camera, s.film, x / 40, y / 40);
      expectNear(part, cameraDirection(whole.camera, whole.film, (x + 10) / 100, (y + 20) / 80),
                 1e-6f);
      const RasterPoint back = projectToFilm(s.camera, s.film, s.camera.position + 3.0f * part);
      EXPECT_NEAR(back.x, x / 40, 1e-5f);
      EXPECT_NEAR(back.y, y / 40, 1e-5f);
    }
  }
  expectError(film + "\"float cropwindow\" [0.5 0.1 0 1]", "1:63",
              {"cropwindow", "xmin xmax ymin ymax"});
}

// ceil() of a fraction that was made from a whole number of pixels may be one more.
TEST_F(PbrtCamera, CropsHaveThePixelsOfPbrt) {
  const std::string camera = "Camera \"perspective\" \"float fov\" 60\n";
  const auto film = [](int width) {
    return "Film \"rgb\" \"integer xresolution\" " + std::to_string(width) +
           " \"integer yresolution\" 80 ";
  };
  for (int end = 1; end <= 1920; end += 7) {
    const std::string bounds = "\"integer pixelbounds\" [0 " + std::to_string(end) + " 0 80]";
    ASSERT_EQ(view(camera + film(1920) + bounds).film.width, uint32_t(end));
  }
  EXPECT_EQ(view(camera + film(400) + "\"float cropwindow\" [0 0.55 0 1]").film.width, 220u);
  const Scene whole = view(camera + film(100)),
              part = view(camera + film(100) + "\"float cropwindow\" [0.335 0.665 0 1]");
  ASSERT_EQ(part.film.width, 33u);  // 34 to 66
  expectNear(cameraDirection(part.camera, part.film, 0.0f, 0.5f),
             cameraDirection(whole.camera, whole.film, 0.34f, 0.5f), 1e-6f);
}

TEST_F(PbrtCamera, ScreenWindowsMayLieAnywhere) {
  const std::string camera = "Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" ";
  const Scene s = view(camera + "[0 2 0.5 2.5]", "100 100");
  const Vec3 middle = cameraDirection(s.camera, s.film, 0.5f, 0.5f);
  expectNear(middle, normalize(s.camera.forward + s.camera.right + 1.5f * s.camera.up), 1e-6f);
}

// Lengths of the lens are those of the camera's space.
TEST_F(PbrtCamera, Lens) {
  const std::string camera =
      "Camera \"perspective\" \"float lensradius\" 0.1 \"float focaldistance\" 3";
  const Scene s = view("LookAt 0 0 -5  0 0 0  0 1 0 " + camera);
  EXPECT_FLOAT_EQ(s.camera.lensRadius, 0.1f);
  EXPECT_FLOAT_EQ(s.camera.focusDistance, 3.0f);
  EXPECT_EQ(countContaining(s.warnings, "lens"), 0u);
  const Scene scaled = view("Scale -2 2 2 LookAt 0 0 -5  0 0 0  0 1 0 " + camera);
  EXPECT_FLOAT_EQ(scaled.camera.lensRadius, 0.05f);  // the world is half as large as it
  EXPECT_FLOAT_EQ(scaled.camera.focusDistance, 1.5f);
  const Scene uneven = view("Scale 2 8 1 " + camera);
  EXPECT_EQ(countContaining(uneven.warnings, "oval lens"), 1u);
  EXPECT_FLOAT_EQ(uneven.camera.lensRadius, 0.025f);
  EXPECT_FLOAT_EQ(view("Camera \"perspective\" \"float lensradius\" 1").camera.focusDistance, 1e6f);
  EXPECT_FALSE(view("Camera \"perspective\" \"float focaldistance\" 3").camera.hasLens());
  expectError("Camera \"perspective\" \"float lensradius\" -1", "1:22", {"lensradius"});
  expectError("Camera \"perspective\" \"float lensradius\" 1 \"float focaldistance\" 0", "1:43",
              {"'focaldistance' must be above 0"});
}

TEST_F(PbrtCamera, PixelFilters) {
  struct Case {
    std::string filter;
    FilterKind kind;
    float radius;
    size_t notes;
  };
  // Variances: of a triangle of radius 2, 2/3; of a flat bell, a parabola, of radius 1.5, 0.45; of
  // our gaussian of radius 1, 0.10198.
  const std::vector<Case> cases{
      {"", FilterKind::Box, 0.5f, 0},
      {"\"box\"", FilterKind::Box, 0.5f, 0},
      {"\"box\" \"float xradius\" 1 \"float yradius\" 1", FilterKind::Box, 1.0f, 0},
      {"\"box\" \"float xradius\" 2", FilterKind::Box, 1.0f, 1},
      {"\"box\" \"float xradius\" .1 \"float yradius\" .1", FilterKind::Box, 0.25f, 1},
      {"\"gaussian\"", FilterKind::Gaussian, 1.5f, 0},
      {"\"gaussian\" \"float xradius\" 2.4 \"float yradius\" 2.4 \"float sigma\" .8",
       FilterKind::Gaussian, 2.4f, 0},
      {"\"gaussian\" \"float sigma\" 100", FilterKind::Gaussian, 2.101f, 1},
      {"\"mitchell\"", FilterKind::Mitchell, 2.0f, 0},
      {"\"mitchell\" \"float B\" 1 \"float C\" 0", FilterKind::Mitchell, 2.0f, 1},
      {"\"triangle\"", FilterKind::Gaussian, 2.557f, 1},
      {"\"sinc\" \"float xradius\" 4 \"float tau\" 3", FilterKind::Mitchell, 2.0f, 1},
      {"\"median\"", FilterKind::Box, 0.5f, 1}};
  for (const Case& c : cases) {
    const Scene s = view(c.filter.empty() ? "" : "PixelFilter " + c.filter);
    EXPECT_EQ(s.film.filter.kind, c.kind) << c.filter;
    EXPECT_NEAR(s.film.filter.radius, c.radius, 2e-3f) << c.filter;
    EXPECT_EQ(countContaining(s.warnings, "PixelFilter"), c.notes) << c.filter;
  }
  EXPECT_EQ(view("").contentHash, view("PixelFilter \"mitchell\"").contentHash);
  EXPECT_EQ(countContaining(view("PixelFilter \"box\" \"float sigma\" 1").warnings, "'sigma'"), 1u);
  expectError("PixelFilter \"box\" \"float xradius\" -1", "1:19", {"xradius"});
}

TEST_F(PbrtCamera, WhatIsNotRenderedIsNoted) {
  EXPECT_EQ(countContaining(view("Camera \"realistic\"").warnings, "'realistic'"), 1u);
  expectError("Camera \"perspective\" \"float screenwindow\" [1 2]", "1:22", {"xmin"});
  expectError("Film \"rgb\" \"integer xresolution\" 0", "1:12", {"xresolution"});
}

}  // namespace
}  // namespace bnvpl
