#include "scene/read/toml/toml_lights.h"

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

// A smaller sun is a point: floats do not resolve directions within it.
constexpr double kMinSunDeg = 1e-4;

constexpr double kSunDeg = 0.533;  // angular diameter as seen from the Earth

const std::vector<std::string> kLightKeys{"name",       "type",       "position",
                                          "direction",  "look_at",    "up",
                                          "intensity",  "power",      "radiance",
                                          "irradiance", "image",      "material",
                                          "width",      "height",     "radius",
                                          "sides",      "cone_deg",   "falloff_deg",
                                          "scale",      "rotate_deg", "angular_diameter_deg",
                                          "group"};

void requireKeys(const TomlSection& s, const std::string& type, std::set<std::string> allowed) {
  allowed.insert({"name", "type", "group"});
  s.requireOnly("a " + type + " light", allowed);
}

// W/sr. The power of a spot is that to all sides, were it a point.
Vec3 intensityOf(const TomlSection& s) {
  if (!s.has("power") && !s.has("intensity")) s.fail("needs 'intensity' or 'power'; add one");
  if (!s.has("power")) return s.color("intensity");
  if (s.has("intensity")) s.fail("needs exactly one of 'power' and 'intensity'");
  return s.color("power") * (0.25f / kPi);
}

Vec3 directionOf(const TomlSection& s, const FilePoint& position) {
  return fromOrigin(tomlDirection(s, position), {});
}

void readPointLight(const TomlSection& s, const FilePoint& position, LightSpec& light) {
  light.emission = intensityOf(s);
  if (light.type == LightType::Point) {
    requireKeys(s, "point", {"position", "intensity", "power"});
    return;
  }
  requireKeys(
      s, "spot",
      {"position", "intensity", "power", "direction", "look_at", "cone_deg", "falloff_deg"});
  light.direction = directionOf(s, position);
  const double coneDeg = s.number("cone_deg", 0.01, 180.0);
  const double falloffDeg = s.number("falloff_deg", 0.0, 180.0, 0.0);
  if (falloffDeg > coneDeg) s.fail(s.node("falloff_deg"), "'falloff_deg' exceeds 'cone_deg'");
  light.coneRad = radians(coneDeg);
  light.falloffRad = radians(falloffDeg);
}

void readDirectionalLight(const TomlSection& s, const std::string& type, LightSpec& light) {
  requireKeys(s, type, {"direction", "irradiance", "angular_diameter_deg"});
  light.direction = s.direction("direction");
  light.emission = s.color("irradiance");
  const double diameterDeg =
      s.number("angular_diameter_deg", 0.0, 170.0, type == "sun" ? kSunDeg : 0.0);
  if (diameterDeg >= kMinSunDeg) light.angularRadiusRad = 0.5f * radians(diameterDeg);
}

void readEnvironment(const TomlSection& s, const FileNames& names, SceneBuilder& builder,
                     LightSpec& light) {
  requireKeys(s, "environment", {"radiance", "image", "rotate_deg", "scale"});
  if (s.has("radiance") == s.has("image")) s.fail("needs exactly one of 'radiance' and 'image'");
  light.scale = static_cast<float>(s.number("scale", 0.0, TomlSection::kMaxMagnitude, 1.0));
  light.rotateRad = radians(s.number("rotate_deg", -1e6, 1e6, 0.0));
  if (s.has("radiance")) {
    light.emission = s.color("radiance");
    return;
  }
  const fs::path image = names.resolve(s, "image");
  if (!isRegularFile(image)) {
    s.fail(s.node("image"),
           image.string() + ": " + whyUnreadable(image, "image") + "; check its name");
  }
  light.image = builder.addEnvironment(image);
}

void readLight(const TomlSection& s, const FileNames& names, SceneBuilder& builder) {
  LightSpec light;
  if (s.has("name")) light.name = s.newName({});
  light.group = tomlLightGroup(s, builder);
  FilePoint position{};
  const std::string type = s.text("type");
  if (type == "point" || type == "spot") {
    light.type = type == "point" ? LightType::Point : LightType::Spot;
    position = s.place("position");
    readPointLight(s, position, light);
  } else if (type == "directional" || type == "sun") {
    light.type = LightType::Directional;
    readDirectionalLight(s, type, light);
  } else if (type == "environment") {
    light.type = LightType::Environment;
    readEnvironment(s, names, builder, light);
  } else {
    s.fail(s.node("type"),
           "unknown type '" + type +
               "'; use rectangle, disk, sphere, point, spot, sun, directional, environment or "
               "material");
  }
  builder.addLight(light, position);
}

// A material light with a group may leave the emission to the material.
SceneBuilder::Emission materialEmission(const TomlSection& s, SceneBuilder& builder) {
  SceneBuilder::Emission emission{{}, false, tomlLightGroup(s, builder)};
  if (!s.has("group") || s.has("radiance")) emission.radiance = s.color("radiance");
  if (!s.has("sides")) return emission;
  if (!emission.radiance) s.fail(s.node("sides"), "'sides' needs 'radiance'");
  emission.twoSided = s.integer("sides", 1, 2) == 2;
  return emission;
}

}  // namespace

uint32_t tomlLightGroup(const TomlSection& s, SceneBuilder& builder) {
  if (!s.has("group")) return 0;
  const std::string name = s.text("group");
  constexpr const char* kCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  constexpr size_t kLongest = 40;
  if (name.empty() || name.size() > kLongest ||
      name.find_first_not_of(kCharacters) != std::string::npos) {
    s.fail(s.node("group"), "'group' names channels of images; use 1 to " +
                                std::to_string(kLongest) + " letters, digits, '_' and '-'");
  }
  const std::optional<uint32_t> group = builder.lightGroup(name);
  if (!group) {
    s.fail(s.node("group"), "more than " + std::to_string(kMaxLightGroups - 1) +
                                " light groups; give some lights the same");
  }
  return *group;
}

FilePoint tomlDirection(const TomlSection& s, const FilePoint& position) {
  if (s.has("direction") == s.has("look_at"))
    s.fail("needs exactly one of 'direction' and 'look_at'");
  const char* key = s.has("direction") ? "direction" : "look_at";
  FilePoint to = s.point(key);
  if (s.has("look_at")) {
    for (size_t i = 0; i < 3; ++i) to[i] -= position[i];
  }
  const double length = std::hypot(to[0], to[1], to[2]);
  if (!(length > 0.0)) {
    s.fail(s.node(key), s.has("direction") ? "'direction' must not be zero"
                                           : "'look_at' equals 'position'; move one of them");
  }
  for (double& x : to) x /= length;
  return to;
}

std::vector<std::string> readTomlEmissions(const fs::path& file, const toml::table& root,
                                           SceneBuilder& builder) {
  std::vector<std::string> out;
  for (const toml::table* t : tablesOf(file, root, "light")) {
    const TomlSection s(file, "[[light]]", *t, kLightKeys);
    if (s.text("type") != "material") continue;
    s.requireOnly("a material light", {"type", "material", "radiance", "sides", "group"});
    out.push_back(s.text("material"));
    if (std::ranges::count(out, out.back()) > 1)
      s.fail(s.node("material"), "the material '" + out.back() + "' has a [[light]] above");
    builder.addEmission(out.back(), materialEmission(s, builder));
  }
  return out;
}

void readTomlLights(const fs::path& file, const toml::table& root, const FileNames& names,
                    SceneBuilder& builder) {
  size_t number = 0;
  for (const toml::table* t : tablesOf(file, root, "light")) {
    const TomlSection s(file, "[[light]]", *t, kLightKeys);
    const std::string type = s.text("type");
    ++number;
    if (type == "material" || readTomlAreaLight(file, s, type, number, builder)) continue;
    readLight(s, names, builder);
  }
}

}  // namespace bnvpl
