#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

TomlFilm readFilm(const TomlSection& s) {
  TomlFilm film;
  if (s.has("filter")) {
    FilterSpec& filter = film.filter.emplace();
    filter.kind = static_cast<FilterKind>(s.choice("filter", kFilterNames));
    filter.radius = static_cast<float>(s.number("filter_radius", kMinFilterRadius, kMaxFilterRadius,
                                                double{usualRadius(filter.kind)}));
  } else if (s.has("filter_radius")) {
    s.fail(s.node("filter_radius"), "'filter_radius' has no effect without 'filter'; add it");
  }
  if (!film.filter || s.has("width") || s.has("height"))
    film.size = {s.integer("width", 1, kMaxFilmSide), s.integer("height", 1, kMaxFilmSide)};
  return film;
}

void readLens(const TomlSection& s, Camera& c) {
  if (s.has("lens_radius"))
    c.lensRadius = static_cast<float>(s.number("lens_radius", 0.0, kMaxLensLength));
  if (s.has("focus_distance")) {
    if (!s.has("lens_radius")) {
      s.fail(s.node("focus_distance"),
             "'focus_distance' has no effect without 'lens_radius'; give both or none");
    }
    c.focusDistance =
        static_cast<float>(s.number("focus_distance", kMinFocusDistance, kMaxLensLength));
  } else if (c.hasLens()) {
    s.fail(s.node("lens_radius"), "'lens_radius' needs 'focus_distance'; add it");
  }
}

// Reads everything but the position.
Camera readCamera(const TomlSection& s, const FilePoint& position, bool mirrored) {
  Camera c;
  if (s.has("look_at") == s.has("forward")) s.fail("needs exactly one of 'look_at' and 'forward'");
  if (s.has("forward")) {
    c.forward = s.direction("forward");
  } else {
    if (!toUnit(s.point("look_at"), position, c.forward))
      s.fail(s.node("look_at"), "'look_at' equals 'position'; move one of them");
  }
  const Vec3 up = s.has("up") ? s.direction("up") : Vec3{0, 1, 0};
  const Vec3 right = cross(c.forward, up);
  if (length(right) < 1e-6f)
    s.fail("'up' is parallel to the viewing direction; choose another 'up'");
  c.right = normalize(right);
  c.up = cross(c.right, c.forward);
  if (s.flag("mirrored", mirrored)) c.right = -c.right;
  c.verticalFovRad = radians(s.number("vertical_fov_deg", 0.001, 179.9));
  if (s.has("shift")) c.shift = s.pair("shift", 1000.0);
  readLens(s, c);
  return c;
}

}  // namespace

Film TomlFilm::over(const Film& film) const {
  Film out = size.value_or(film);
  out.filter = filter.value_or(film.filter);
  return out;
}

TomlView readTomlView(const fs::path& file, const toml::table& root, bool mirrored) {
  TomlView view;
  if (root.contains("film")) {
    view.film = readFilm(TomlSection(file, "[film]", tableOf(file, root, "film"),
                                     {"width", "height", "filter", "filter_radius"}));
  }
  if (root.contains("camera")) {
    const TomlSection camera(file, "[camera]", tableOf(file, root, "camera"),
                             {"position", "look_at", "forward", "up", "vertical_fov_deg", "shift",
                              "mirrored", "lens_radius", "focus_distance"});
    view.position = camera.place("position");
    view.camera = readCamera(camera, view.position, mirrored);
  }
  return view;
}

}  // namespace bnvpl
