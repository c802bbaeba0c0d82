#include "scene/read/pbrt/camera.h"

#include <cmath>
#include <numbers>

#include "scene/read/pbrt/pixel_filter.h"
#include "scene/read/pbrt/syntax/transform.h"

namespace bnvpl::pbrt {

namespace {

// The pixels that are rendered: all of the film, or a crop of it.
struct Pixels {
  Film film;
  uint32_t left = 0, right = 0, top = 0, bottom = 0;  // bounds of the crop; right > left
  Film cropped() const { return {right - left, bottom - top}; }
};

// `inPixels`: the bounds are pixels, else fractions of the film, of which pbrt takes the pixels
// from ceil(from n) to ceil(to n), computed in floats.
void readCrop(const Param& window, bool inPixels, Pixels& out) {
  const double w = inPixels ? out.film.width : 1.0, h = inPixels ? out.film.height : 1.0;
  const auto& n = window.numbers;
  if (n.size() != 4 ||
      !(n[0] >= 0 && n[1] > n[0] && n[1] <= w && n[2] >= 0 && n[3] > n[2] && n[3] <= h))
    failAt(window.place, "'" + std::string(inPixels ? "pixelbounds" : "cropwindow") +
                             "' must be xmin xmax ymin ymax within the film");
  const auto pixel = [&](double bound, uint32_t size) {
    const float at = inPixels ? float(bound) : std::ceil(float(bound) * float(size));
    return static_cast<uint32_t>(at);
  };
  const auto take = [&](double from, double to, uint32_t size, uint32_t& first, uint32_t& end) {
    first = std::min(pixel(from, size), size - 1);
    end = std::clamp(pixel(to, size), first + 1, size);
  };
  take(n[0], n[1], out.film.width, out.left, out.right);
  take(n[2], n[3], out.film.height, out.top, out.bottom);
}

Pixels pixelsOf(const Description& description, Notes& notes) {
  const Params& p = description.film.params;
  Pixels out;
  Film& film = out.film;
  film.width = static_cast<uint32_t>(p.integer("xresolution", 1280, 1, kMaxFilmSide));
  film.height = static_cast<uint32_t>(p.integer("yresolution", 720, 1, kMaxFilmSide));
  out.right = film.width, out.bottom = film.height;
  if (const Param* crop = p.find("pixelbounds", {ParamType::Integer}, "four integers"))
    readCrop(*crop, true, out);
  if (const Param* crop = p.find("cropwindow", {ParamType::Float}, "four floats"))
    readCrop(*crop, false, out);  // it counts where both are given
  if (const Place* at = p.placeOf("maxcomponentvalue");
      at && p.number("maxcomponentvalue", kMax) < kMax)
    notes.add(*at, "'maxcomponentvalue' is ignored: no sample is clamped");
  p.ignore({"filename", "savefp16", "diagonal", "quickrender", "nbuckets", "lambdamin", "lambdamax",
            "coordinatesystem"});
  return out;
}

// The visible part of the plane at distance 1.
struct Window {
  double halfHeight, centreX, centreY;  // y counts upwards
};
Window windowOf(const Description& description, const Film& film, Notes& notes) {
  const Entity& camera = description.camera;
  const Params& p = camera.params;
  const double pixels = double(film.width) / double(film.height);
  const double aspect = p.number("frameaspectratio", pixels, 1e-3, 1e3);
  // The screen window of pbrt, where the field of view ends at 1.
  std::array<double, 4> screen = aspect > 1.0 ? std::array{-aspect, aspect, -1.0, 1.0}
                                              : std::array{-1.0, 1.0, -1.0 / aspect, 1.0 / aspect};
  if (const Param* window = p.find("screenwindow", {ParamType::Float}, "four floats")) {
    if (window->numbers.size() != 4 || !(window->numbers[1] > window->numbers[0]) ||
        !(window->numbers[3] > window->numbers[2]))
      failAt(window->place, "'screenwindow' must be xmin xmax ymin ymax");
    for (size_t i = 0; i < 4; ++i) screen[i] = window->numbers[i];
  }
  const double width = screen[1] - screen[0], height = screen[3] - screen[2];
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
  return {0.5 * height * scale, 0.5 * (screen[0] + screen[1]) * scale,
          0.5 * (screen[2] + screen[3]) * scale};
}

void aim(const Window& window, const Pixels& pixels, Camera& camera) {
  const double half = window.halfHeight,
               aspect = double(pixels.film.width) / double(pixels.film.height);
  const Film cropped = pixels.cropped();
  const double part = double(cropped.height) / double(pixels.film.height);
  camera.verticalFovRad = static_cast<float>(2.0 * std::atan(half * part));
  const auto centre = [](uint32_t first, uint32_t end, uint32_t size) {
    return double(first + end) / double(size) - 1.0;  // the film is from -1 to 1
  };
  const double x =
      window.centreX + half * aspect * centre(pixels.left, pixels.right, pixels.film.width);
  const double y = window.centreY - half * centre(pixels.top, pixels.bottom, pixels.film.height);
  camera.shift = {static_cast<float>(x / (2.0 * half * part)),
                  static_cast<float>(y / (2.0 * half * part))};
}

double lengthOf(const FilePoint& v) { return std::hypot(v[0], v[1], v[2]); }

// Lengths are those of the camera's space, which its transform may scale.
void readLens(const Entity& entity, const Affine& worldFromCamera, Notes& notes, Camera& camera) {
  const Params& p = entity.params;
  const double radius = p.number("lensradius", 0.0, 0.0), distance = p.number("focaldistance", 1e6);
  if (!(radius > 0.0)) return;
  const double across = lengthOf(direction(worldFromCamera, {1, 0, 0})),
               up = lengthOf(direction(worldFromCamera, {0, 1, 0})),
               along = lengthOf(direction(worldFromCamera, {0, 0, 1}));
  if (std::fabs(across - up) > 1e-3 * across)
    notes.add(*p.placeOf("lensradius"), "an oval lens is rendered as a circle of the same area");
  const double lens = radius * std::sqrt(across * up);
  double focus = distance * along;
  if (focus > kMaxLensLength) {
    notes.add(*p.placeOf("focaldistance"), "a focus beyond 1e9 in the world is put there");
    focus = kMaxLensLength;
  }
  if (!(lens <= kMaxLensLength)) failAt(*p.placeOf("lensradius"), "the lens is too large");
  if (!(focus >= kMinFocusDistance)) {
    const Place* given = p.placeOf("focaldistance");
    failAt(given ? *given : entity.place, "'focaldistance' must be above 0");
  }
  camera.lensRadius = static_cast<float>(lens);
  camera.focusDistance = static_cast<float>(focus);
}

bool unit(FilePoint v, Vec3& out) {
  const double length = lengthOf(v);
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
  const Pixels pixels = pixelsOf(description, notes);
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
  // Orthonormalises the axes and keeps the handedness of the transform. An unmirrored camera of
  // pbrt has x to the right in a left-handed frame, so that right x up is forward.
  camera.right = normalize(camera.right - dot(camera.right, camera.forward) * camera.forward);
  camera.up = cross(camera.forward, camera.right);
  Vec3 up;
  if (unit(axis(0, 1, 0), up) && dot(up, camera.up) < 0.0f) camera.up = -camera.up;
  aim(windowOf(description, pixels.film, notes), pixels, camera);
  constexpr float kMin = 1e-5f, kMaxFov = 3.1415f;
  if (!(camera.verticalFovRad > kMin && camera.verticalFovRad < kMaxFov))
    failAt(entity.place, "the field of view is too small or too large");
  readLens(entity, *worldFromCamera, notes, camera);
  // Adding 0.0 turns -0 into 0.
  const FilePoint position = worldFromCamera->point({0, 0, 0});
  Film film = pixels.cropped();
  film.filter = filterOf(description, notes);
  const bool given = entity.place.file || !builder.including();
  if (given)
    builder.addCamera("", {position[0] + 0.0, position[1] + 0.0, position[2] + 0.0}, camera, film);
}

}  // namespace bnvpl::pbrt
