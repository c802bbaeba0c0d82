#include "scene/read/toml/scene_toml.h"

#include <algorithm>
#include <numbers>
#include <set>

#include "scene/read/obj/load_obj.h"
#include "scene/read/toml/toml_section.h"
#include "scene/read/toml/toml_surfaces.h"
#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

constexpr double kMaxMagnitude = TomlSection::kMaxMagnitude;
// A smaller sun is a point: floats do not resolve directions within it.
constexpr double kMinSunDeg = 1e-4;

const std::vector<std::string> kInstanceKeys{"name", "transform", "translate", "rotate_deg",
                                             "scale"};

Affine readMatrix(const TomlSection& s) {
  const auto rows = s.rows("transform", 4, 4);
  if (rows[3] != std::vector<double>{0, 0, 0, 1})
    s.fail(s.node("transform"), "the last row of 'transform' must be 0, 0, 0, 1");
  Affine a;
  for (size_t i = 0; i < 3; ++i) std::ranges::copy(rows[i], a.m[i].begin());
  return a;
}

Affine readTransform(const TomlSection& s) {
  const bool parts = s.has("translate") || s.has("rotate_deg") || s.has("scale");
  if (s.has("transform")) {
    if (parts) s.fail("has 'transform' and translate/rotate_deg/scale; use one or the other");
    return readMatrix(s);
  }
  FilePoint scale{1, 1, 1}, rotate{}, translate{};
  if (s.has("scale")) {
    if (s.node("scale").is_array())
      scale = s.point("scale");
    else
      scale.fill(s.number("scale", -kMaxMagnitude, kMaxMagnitude));
  }
  if (s.has("rotate_deg")) rotate = s.point("rotate_deg");
  for (double& angle : rotate) angle *= std::numbers::pi / 180.0;
  if (s.has("translate")) translate = s.point("translate");
  return Affine::fromParts(translate, rotate, scale);
}

const std::vector<std::string> kLightKeys{
    "type",       "position", "direction", "intensity",   "irradiance",
    "radiance",   "image",    "cone_deg",  "falloff_deg", "angular_diameter_deg",
    "rotate_deg", "scale"};

void requireKeys(const TomlSection& s, const std::string& type, std::set<std::string> allowed) {
  allowed.insert("type");
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
  light.scale = static_cast<float>(s.number("scale", 0.0, kMaxMagnitude, 1.0));
  light.rotateRad = radians(s.number("rotate_deg", -1e6, 1e6, 0.0));
  if (s.has("radiance"))
    light.emission = s.color("radiance");
  else
    light.image = builder.addEnvironment(names.resolve(s, "image"));
}

void readLight(const TomlSection& s, const FileNames& names, SceneBuilder& builder) {
  LightSpec light;
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

void readMesh(const fs::path& file, const toml::table& table, const FileNames& names,
              SceneBuilder& builder) {
  const TomlSection s(
      file, "[[mesh]]", table,
      {"file", "materials", "transform", "translate", "rotate_deg", "scale", "instance"});
  const fs::path materials = s.has("materials") ? names.resolve(s, "materials") : fs::path();
  const auto load = [&] {
    loadObj(names.resolve(s, "file"), materials, readTransform(s), builder);
  };
  if (!s.has("instance")) return load();
  const uint32_t prototype = builder.beginPrototype();
  load();
  builder.endPrototype();
  for (const toml::table* t : tablesOf(file, table, "instance", "mesh.instance")) {
    const TomlSection instance(file, "[[mesh.instance]]", *t, kInstanceKeys);
    builder.addInstance(prototype, readTransform(instance),
                        instance.has("name") ? builder.addObject(instance.newName({})) : kNone);
  }
}

}  // namespace

void readSceneToml(const fs::path& file, const Defines& defines, SceneBuilder& builder) {
  const toml::table root = parseToml(file);
  const TomlSection top(file, "scene", root,
                        {"film", "camera", "texture", "material", "mesh", "light"});
  const FileNames names(file, defines);

  // Small sections come first, so that mistakes in them show before the meshes are read.
  const TomlView view = readTomlView(file, root);
  builder.setFilm(view.film);
  builder.setCamera(view.position, view.camera);

  const auto meshes = tablesOf(file, root, "mesh");
  if (meshes.empty())
    throw InputError(file, "has no triangle; name at least one OBJ file in a [[mesh]]");
  const TomlSurfaces surfaces(file, root, names, builder);
  for (const toml::table* t : meshes) readMesh(file, *t, names, builder);
  surfaces.warnOfUnused();
  for (const toml::table* t : tablesOf(file, root, "light"))
    readLight(TomlSection(file, "[[light]]", *t, kLightKeys), names, builder);
}

}  // namespace bnvpl
