#include "scene/read/toml/scene_toml.h"

#include <cstdlib>
#include <numbers>
#include <set>

#include "scene/read/obj/load_obj.h"
#include "scene/read/toml/toml_section.h"
#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

constexpr double kMaxMagnitude = TomlSection::kMaxMagnitude;
// A smaller sun is a point: the direction of no float ray lies in it.
constexpr double kMinSunDeg = 1e-4;

// Names in the file: with ${NAME} filled in, and relative to its folder unless absolute.
class FileNames {
 public:
  FileNames(const fs::path& sceneFile, const Defines& defines)
      : folder_(sceneFile.parent_path()), defines_(defines) {}

  fs::path resolve(const TomlSection& section, const char* key) const {
    return (folder_ / expand(section, key)).lexically_normal();
  }

 private:
  std::string expand(const TomlSection& section, const char* key) const {
    const std::string text = section.fileName(key);
    std::string out;
    for (size_t i = 0; i < text.size();) {
      const size_t end = text.compare(i, 2, "${") == 0 ? text.find('}', i) : std::string::npos;
      if (end == std::string::npos) {
        out += text[i++];
        continue;
      }
      const std::string name = text.substr(i + 2, end - i - 2);
      if (const std::string* given = defines_.find(name)) {
        out += *given;
      } else if (const char* value = std::getenv(name.c_str())) {
        out += value;
      } else {
        section.fail(section.node(key), "${" + name + "} is not set; pass --define " + name +
                                            "=FOLDER or set the environment variable " + name);
      }
      i = end + 1;
    }
    return out;
  }

  fs::path folder_;
  const Defines& defines_;
};

Affine readMatrix(const TomlSection& s) {
  const toml::array* rows = s.node("transform").as_array();
  Affine a;
  for (size_t i = 0; i < 4; ++i) {
    const toml::array* row = rows && rows->size() == 4 ? rows->get(i)->as_array() : nullptr;
    if (!row || row->size() != 4)
      s.fail(s.node("transform"), "'transform' must be four rows of four numbers");
    for (size_t j = 0; j < 4; ++j) {
      const double v = s.numberOf(*row->get(j), "transform", -kMaxMagnitude, kMaxMagnitude);
      if (i < 3)
        a.m[i][j] = v;
      else if (v != (j == 3 ? 1.0 : 0.0))
        s.fail(*row, "the last row of 'transform' must be 0, 0, 0, 1");
    }
  }
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

// A key of another type would be ignored.
void requireKeys(const TomlSection& s, const std::string& type,
                 const std::set<std::string>& allowed) {
  for (const std::string& key : kLightKeys) {
    if (key != "type" && s.has(key.c_str()) && !allowed.contains(key)) {
      s.fail(s.node(key.c_str()),
             "'" + key + "' has no meaning for a " + type + " light; remove it");
    }
  }
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

}  // namespace

void readSceneToml(const fs::path& file, const Defines& defines, SceneBuilder& builder) {
  const toml::table root = parseToml(file);
  const TomlSection top(file, "scene", root, {"film", "camera", "mesh", "light"});
  const FileNames names(file, defines);

  // What is small comes first: a mistake in it shows before the meshes are read.
  const TomlView view = readTomlView(file, root);
  builder.setFilm(view.film);
  builder.setCamera(view.position, view.camera);

  const auto meshes = tablesOf(file, root, "mesh");
  if (meshes.empty())
    throw InputError(file, "has no triangle; name at least one OBJ file in a [[mesh]]");
  for (const toml::table* t : meshes) {
    const TomlSection s(file, "[[mesh]]", *t,
                        {"file", "materials", "transform", "translate", "rotate_deg", "scale"});
    const fs::path materials = s.has("materials") ? names.resolve(s, "materials") : fs::path();
    loadObj(names.resolve(s, "file"), materials, readTransform(s), builder);
  }
  for (const toml::table* t : tablesOf(file, root, "light"))
    readLight(TomlSection(file, "[[light]]", *t, kLightKeys), names, builder);
}

}  // namespace bnvpl
