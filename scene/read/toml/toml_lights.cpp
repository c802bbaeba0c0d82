#include "scene/read/toml/toml_lights.h"

#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

// A smaller sun is a point: floats do not resolve directions within it.
constexpr double kMinSunDeg = 1e-4;

const std::vector<std::string> kLightKeys{"name",
                                          "type",
                                          "position",
                                          "direction",
                                          "intensity",
                                          "irradiance",
                                          "radiance",
                                          "image",
                                          "cone_deg",
                                          "falloff_deg",
                                          "angular_diameter_deg",
                                          "rotate_deg",
                                          "scale"};

void requireKeys(const TomlSection& s, const std::string& type, std::set<std::string> allowed) {
  allowed.insert({"name", "type"});
  s.requireOnly("a " + type + " light", allowed);
}

void readPointLight(const TomlSection& s, LightSpec& light) {
  light.emission = s.color("intensity");
  if (light.type == LightType::Point) {
    requireKeys(s, "point", {"position", "intensity"});
    return;
  }
  requireKeys(s, "spot", {"position", "intensity", "direction", "cone_deg", "falloff_deg"});
  light.direction = s.direction("direction");
  const double coneDeg = s.number("cone_deg", 0.01, 180.0);
  const double falloffDeg = s.number("falloff_deg", 0.0, 180.0, 0.0);
  if (falloffDeg > coneDeg) s.fail(s.node("falloff_deg"), "'falloff_deg' exceeds 'cone_deg'");
  light.coneRad = radians(coneDeg);
  light.falloffRad = radians(falloffDeg);
}

void readDirectionalLight(const TomlSection& s, LightSpec& light) {
  requireKeys(s, "directional", {"direction", "irradiance", "angular_diameter_deg"});
  light.direction = s.direction("direction");
  light.emission = s.color("irradiance");
  const double diameterDeg = s.number("angular_diameter_deg", 0.0, 170.0, 0.0);
  if (diameterDeg >= kMinSunDeg) light.angularRadiusRad = 0.5f * radians(diameterDeg);
}

void readEnvironment(const TomlSection& s, const FileNames& names, SceneBuilder& builder,
                     LightSpec& light) {
  requireKeys(s, "environment", {"radiance", "image", "rotate_deg", "scale"});
  if (s.has("radiance") == s.has("image")) s.fail("needs exactly one of 'radiance' and 'image'");
  light.scale = static_cast<float>(s.number("scale", 0.0, TomlSection::kMaxMagnitude, 1.0));
  light.rotateRad = radians(s.number("rotate_deg", -1e6, 1e6, 0.0));
  if (s.has("radiance"))
    light.emission = s.color("radiance");
  else
    light.image = builder.addEnvironment(names.resolve(s, "image"));
}

void readLight(const TomlSection& s, const FileNames& names, SceneBuilder& builder) {
  LightSpec light;
  if (s.has("name")) light.name = s.newName({});
  FilePoint position{};
  const std::string type = s.text("type");
  if (type == "point" || type == "spot") {
    light.type = type == "point" ? LightType::Point : LightType::Spot;
    position = s.place("position");
    readPointLight(s, light);
  } else if (type == "directional") {
    light.type = LightType::Directional;
    readDirectionalLight(s, light);
  } else if (type == "environment") {
    light.type = LightType::Environment;
    readEnvironment(s, names, builder, light);
  } else {
    s.fail(s.node("type"),
           "unknown type '" + type + "'; use point, spot, directional or environment");
  }
  builder.addLight(light, position);
}

}  // namespace

void readTomlLights(const fs::path& file, const toml::table& root, const FileNames& names,
                    SceneBuilder& builder) {
  for (const toml::table* t : tablesOf(file, root, "light"))
    readLight(TomlSection(file, "[[light]]", *t, kLightKeys), names, builder);
}

}  // namespace bnvpl
