#include "scene/read/pbrt/camera.h"

#include <cmath>
#include <numbers>

#include "scene/read/pbrt/transform.h"

namespace bnvpl::pbrt {

namespace {

Film filmOf(const Description& description, Notes& notes) {
  const Params& p = description.film.params;
  Film film;
  film.width = static_cast<uint32_t>(p.integer("xresolution", 1280, 1, kMaxFilmSide));
  film.height = static_cast<uint32_t>(p.integer("yresolution", 720, 1, kMaxFilmSide));
  if (p.has("cropwindow") || p.has("pixelbounds")) {
    notes.add(*p.placeOf(p.has("cropwindow") ? "cropwindow" : "pixelbounds"),
              "the film is not cropped: the whole of it is rendered");
  }
  p.ignore({"filename", "savefp16", "diagonal", "maxcomponentvalue", "quickrender", "nbuckets",
            "lambdamin", "lambdamax", "coordinatesystem"});
  return film;
}

// The part of the plane at distance 1 that is seen: half its height.
double halfHeight(const Description& description, const Film& film, Notes& notes) {
  const Entity& camera = description.camera;
  const Params& p = camera.params;
  const double pixels = double(film.width) / double(film.height);
  const double aspect = p.number("frameaspectratio", pixels, 1e-3, 1e3);
  // pbrt's screen: 1 is what the field of view ends at.
  std::array<double, 4> screen = aspect > 1.0 ? std::array{-aspect, aspect, -1.0, 1.0}
                                              : std::array{-1.0, 1.0, -1.0 / aspect, 1.0 / aspect};
  if (const Param* window = p.find("screenwindow", {ParamType::Float}, "four floats")) {
    if (window->numbers.size() != 4 || !(window->numbers[1] > window->numbers[0]) ||
        !(window->numbers[3] > window->numbers[2]))
      failAt(window->place, "'screenwindow' must be xmin xmax ymin ymax");
    for (size_t i = 0; i < 4; ++i) screen[i] = window->numbers[i];
  }
  const double width = screen[1] - screen[0], height = screen[3] - screen[2];
  if (std::fabs(screen[0] + screen[1]) > 1e-4 * width ||
      std::fabs(screen[2] + screen[3]) > 1e-4 * height)
    notes.add(camera.place, "the camera's screen window is not in its centre; it is moved there");
  if (std::fabs(width / height - pixels) > 1e-3 * pixels) {
    notes.add(camera.place,
              "the camera's frame has another aspect than the film's pixels; its "
              "height is kept, and pixels are square");
  }
  double scale = 1.0;
  if (camera.type == "perspective") {
    double fov = p.number("fov", 90.0, 1e-3, 179.9);
    const double half = p.number("halffov", 0.0, 0.0, 89.95);
    if (half > 0.0) fov = 2.0 * half;
    scale = std::tan(0.5 * fov * std::numbers::pi / 180.0);
  }
  return 0.5 * height * scale;
}

bool unit(FilePoint v, Vec3& out) {
  const double length = std::hypot(v[0], v[1], v[2]);
  if (!(length > 0.0) || !std::isfinite(length)) return false;
  out = {float(v[0] / length), float(v[1] / length), float(v[2] / length)};
  return true;
}

}  // namespace

Vec3 Sensor::operator()(Vec3 light) const {
  return max(Vec3{dot(rows[0], light), dot(rows[1], light), dot(rows[2], light)}, Vec3{});
}

Sensor sensorOf(const Description& description, Notes& notes) {
  const Params &film = description.film.params, &camera = description.camera.params;
  const double open = camera.number("shutteropen", 0.0), close = camera.number("shutterclose", 1.0);
  const double ratio = (close - open) * film.number("iso", 100.0, 1e-6, 1e9) / 100.0;
  if (!(ratio > 0.0)) failAt(description.camera.place, "the shutter closes before it opens");
  const double balance = film.number("whitebalance", 0.0, 0.0, 25000.0);
  if (film.text("sensor", "cie1931") != "cie1931")
    notes.add(*film.placeOf("sensor"), "the camera's sensor is taken as the CIE 1931 observer");
  Sensor sensor;
  if (balance >= 1000.0) sensor.rows = whiteBalance(balance);
  for (Vec3& row : sensor.rows) row *= static_cast<float>(ratio);
  return sensor;
}

void buildCamera(const Description& description, Notes& notes, SceneBuilder& builder) {
  const Entity& entity = description.camera;
  const Film film = filmOf(description, notes);
  builder.setFilm(film);
  if (entity.type != "perspective") {
    notes.add(entity.place, "camera '" + entity.type +
                                "' is not read; a perspective one of 90 "
                                "degrees stands in its place");
  }
  const std::optional<Affine> worldFromCamera = inverse(description.cameraFromWorld);
  if (!worldFromCamera) failAt(entity.place, "the camera's transform has no inverse");
  Camera camera;
  const auto axis = [&](double x, double y, double z) {
    return direction(*worldFromCamera, {x, y, z});
  };
  if (!unit(axis(0, 0, 1), camera.forward) || !unit(axis(1, 0, 0), camera.right))
    failAt(entity.place, "the camera's transform flattens it");
  // Orthonormal, and on the sides that the transform gives: a camera of pbrt that nothing mirrors
  // has x to the right of a left-handed frame, so that right x up is forward.
  camera.right = normalize(camera.right - dot(camera.right, camera.forward) * camera.forward);
  camera.up = cross(camera.forward, camera.right);
  Vec3 up;
  if (unit(axis(0, 1, 0), up) && dot(up, camera.up) < 0.0f) camera.up = -camera.up;
  const double half = halfHeight(description, film, notes);
  camera.verticalFovRad = static_cast<float>(2.0 * std::atan(half));
  constexpr float kLeast = 1e-5f, kMostFov = 3.1415f;
  if (!(camera.verticalFovRad > kLeast && camera.verticalFovRad < kMostFov))
    failAt(entity.place, "the field of view is too small or too large");
  // + 0.0: not -0.
  const FilePoint position = worldFromCamera->point({0, 0, 0});
  builder.setCamera({position[0] + 0.0, position[1] + 0.0, position[2] + 0.0}, camera);
  const Params& p = entity.params;
  if (p.number("lensradius", 0.0, 0.0) > 0.0)
    notes.add(*p.placeOf("lensradius"), "depth of field is not rendered: everything is sharp");
  p.ignore({"focaldistance"});
}

}  // namespace bnvpl::pbrt
