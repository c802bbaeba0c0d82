// scene.toml -> Scene, with the meshes and images that it names. Only toml++ include.
#include <toml++/toml.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <set>

#include "core/files.h"
#include "core/sampling.h"
#include "scene/read/obj/load_obj.h"
#include "scene/read/read_file.h"
#include "scene/scene.h"
#include "scene/scene_hash.h"

namespace bnvpl {

namespace {

constexpr float kRadPerDeg = kPi / 180.0f;
// A smaller sun is a point: the direction of no float ray lies in it.
constexpr float kMinSunDeg = 1e-4f;
// Sizes of scenes that floats hold: products of four lengths must stay in range.
constexpr float kSmallestScene = 1e-6f, kLargestScene = 1e9f;

size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0]++;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

// The direction from one place to another, of unit length. False: there is none.
bool toUnit(const FilePoint& to, const FilePoint& from, Vec3& unit) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  if (!(length > 0.0)) return false;
  unit = fromOrigin(
      {(to[0] - from[0]) / length, (to[1] - from[1]) / length, (to[2] - from[2]) / length}, {});
  return true;
}

// A table of the file, read key by key; every key must be known, every value in range.
class Section {
 public:
  Section(const fs::path& file, std::string name, const toml::table& table,
          const std::vector<std::string>& known)
      : file_(file), name_(std::move(name)), table_(table) {
    for (const auto& [key, node] : table_) checkKnown(std::string(key.str()), node, known);
  }

  [[noreturn]] void fail(const toml::node& node, const std::string& problem) const {
    throw InputError(file_.string() + ":" + std::to_string(node.source().begin.line) + ": " +
                     name_ + ": " + problem);
  }
  [[noreturn]] void fail(const std::string& problem) const { fail(table_, problem); }
  bool has(const char* key) const { return table_.contains(key); }
  const toml::node& node(const char* key) const {
    const toml::node* n = table_.get(key);
    if (!n) fail(std::string("needs '") + key + "'; add it");
    return *n;
  }

  float number(const char* key, float least, float most) const {
    return static_cast<float>(numberOf(node(key), key, double{least}, double{most}));
  }
  float number(const char* key, float least, float most, float otherwise) const {
    return has(key) ? number(key, least, most) : otherwise;
  }
  uint32_t integer(const char* key, uint32_t least, uint32_t most) const {
    const auto v = node(key).value_exact<int64_t>();
    if (!v || *v < int64_t{least} || *v > int64_t{most}) {
      fail(node(key), std::string("'") + key + "' must be a whole number from " +
                          std::to_string(least) + " to " + std::to_string(most));
    }
    return static_cast<uint32_t>(*v);
  }
  std::string text(const char* key) const {
    const auto v = node(key).value_exact<std::string>();
    if (!v) fail(node(key), std::string("'") + key + "' must be a text in quotes");
    return *v;
  }
  FilePoint point(const char* key) const {
    const toml::array* a = node(key).as_array();
    if (!a || a->size() != 3) fail(node(key), std::string("'") + key + "' must be [x, y, z]");
    FilePoint v;
    for (size_t i = 0; i < 3; ++i) v[i] = numberOf(*a->get(i), key, -1e30, 1e30);
    return v;
  }
  Vec3 vector(const char* key) const { return fromOrigin(point(key), {}); }
  Vec3 color(const char* key) const {  // W-like: three numbers that are not negative
    const Vec3 c = vector(key);
    if (c.x < 0 || c.y < 0 || c.z < 0)
      fail(node(key), std::string("'") + key + "' must not be negative");
    return c;
  }
  Vec3 direction(const char* key) const {
    Vec3 unit;
    if (!toUnit(point(key), {}, unit))
      fail(node(key), std::string("'") + key + "' must not be zero");
    return unit;
  }
  double numberOf(const toml::node& n, const char* key, double least, double most) const {
    const auto v = n.value<double>();
    if (!v || !std::isfinite(*v)) fail(n, std::string("'") + key + "' must be a number");
    if (*v < least || *v > most) {
      std::ostringstream range;
      range << "'" << key << "' is " << *v << ", outside " << least << " to " << most;
      fail(n, range.str());
    }
    return *v;
  }

 private:
  void checkKnown(const std::string& key, const toml::node& node,
                  const std::vector<std::string>& known) const {
    if (std::find(known.begin(), known.end(), key) != known.end()) return;
    const auto nearest = std::min_element(
        known.begin(), known.end(),
        [&](const auto& a, const auto& b) { return editDistance(key, a) < editDistance(key, b); });
    fail(node, "unknown key '" + key + "'; did you mean '" + *nearest + "'?");
  }

  const fs::path& file_;
  std::string name_;
  const toml::table& table_;
};

std::string expandDefines(const Section& section, const char* key, const Defines& defines) {
  std::string text = section.text(key), out;
  for (size_t i = 0; i < text.size();) {
    const size_t end = text.compare(i, 2, "${") == 0 ? text.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      out += text[i++];
      continue;
    }
    const std::string name = text.substr(i + 2, end - i - 2);
    if (const auto it = defines.find(name); it != defines.end()) {
      out += it->second;
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

// Normalised, relative to the scene.toml unless absolute.
fs::path resolve(const fs::path& sceneFile, const std::string& name) {
  return (sceneFile.parent_path() / name).lexically_normal();
}

Camera readCamera(const Section& s, const FilePoint& origin) {
  Camera c;
  c.position = fromOrigin(s.point("position"), origin);
  if (s.has("look_at") == s.has("forward")) s.fail("needs exactly one of 'look_at' and 'forward'");
  if (s.has("forward")) {
    c.forward = s.direction("forward");
  } else {
    if (!toUnit(s.point("look_at"), s.point("position"), c.forward))
      s.fail(s.node("look_at"), "'look_at' equals 'position'; move one of them");
  }
  const Vec3 up = s.has("up") ? s.direction("up") : Vec3{0, 1, 0};
  const Vec3 right = cross(c.forward, up);
  if (length(right) < 1e-6f)
    s.fail("'up' is parallel to the viewing direction; choose another 'up'");
  c.right = normalize(right);
  c.up = cross(c.right, c.forward);
  c.verticalFovRad = s.number("vertical_fov_deg", 1e-3f, 179.9f) * kRadPerDeg;
  return c;
}

Affine readTransform(const Section& s) {
  const bool parts = s.has("translate") || s.has("rotate_deg") || s.has("scale");
  if (s.has("transform")) {
    if (parts) s.fail("has 'transform' and translate/rotate_deg/scale; use one or the other");
    const toml::array* rows = s.node("transform").as_array();
    Affine a;
    for (size_t i = 0; i < 4; ++i) {
      const toml::array* row = rows && rows->size() == 4 ? rows->get(i)->as_array() : nullptr;
      if (!row || row->size() != 4)
        s.fail(s.node("transform"), "'transform' must be four rows of four numbers");
      for (size_t j = 0; j < 4; ++j) {
        const double v = s.numberOf(*row->get(j), "transform", -1e30, 1e30);
        if (i < 3)
          a.m[i][j] = v;
        else if (v != (j == 3 ? 1.0 : 0.0))
          s.fail(*row, "the last row of 'transform' must be 0, 0, 0, 1");
      }
    }
    return a;
  }
  FilePoint scale{1, 1, 1}, rotate{}, translate{};
  if (s.has("scale")) {
    if (s.node("scale").is_array())
      scale = s.point("scale");
    else
      scale.fill(s.numberOf(s.node("scale"), "scale", -1e30, 1e30));
  }
  if (s.has("rotate_deg")) rotate = s.point("rotate_deg");
  for (double& angle : rotate) angle *= std::numbers::pi / 180.0;
  if (s.has("translate")) translate = s.point("translate");
  return Affine::fromParts(translate, rotate, scale);
}

LightSpec readLight(const fs::path& file, const Section& s, const Defines& defines, Scene& scene) {
  LightSpec light;
  const std::string type = s.text("type");
  // A key of another type would be ignored.
  const auto only = [&](const std::set<std::string>& allowed) {
    for (const char* key :
         {"position", "direction", "intensity", "irradiance", "radiance", "image", "cone_deg",
          "falloff_deg", "angular_diameter_deg", "rotate_deg", "scale"}) {
      if (s.has(key) && !allowed.contains(key)) {
        s.fail(s.node(key),
               "'" + std::string(key) + "' has no meaning for a " + type + " light; remove it");
      }
    }
  };
  if (type == "point" || type == "spot") {
    light.type = type == "point" ? LightType::Point : LightType::Spot;
    light.position = fromOrigin(s.point("position"), scene.origin);
    light.emission = s.color("intensity");
    if (type == "point") {
      only({"position", "intensity"});
    } else {
      only({"position", "intensity", "direction", "cone_deg", "falloff_deg"});
      light.direction = s.direction("direction");
      light.coneRad = s.number("cone_deg", 0.01f, 180.0f) * kRadPerDeg;
      light.falloffRad = s.number("falloff_deg", 0.0f, 180.0f, 0.0f) * kRadPerDeg;
      if (light.falloffRad > light.coneRad)
        s.fail(s.node("falloff_deg"), "'falloff_deg' exceeds 'cone_deg'");
    }
  } else if (type == "directional") {
    only({"direction", "irradiance", "angular_diameter_deg"});
    light.type = LightType::Directional;
    light.direction = s.direction("direction");
    light.emission = s.color("irradiance");
    const float diameterDeg = s.number("angular_diameter_deg", 0.0f, 170.0f, 0.0f);
    if (diameterDeg >= kMinSunDeg) light.angularRadiusRad = 0.5f * diameterDeg * kRadPerDeg;
  } else if (type == "environment") {
    only({"radiance", "image", "rotate_deg", "scale"});
    light.type = LightType::Environment;
    if (s.has("radiance") == s.has("image")) s.fail("needs exactly one of 'radiance' and 'image'");
    light.scale = s.number("scale", 0.0f, 1e30f, 1.0f);
    light.rotateRad = s.number("rotate_deg", -1e6f, 1e6f, 0.0f) * kRadPerDeg;
    if (s.has("radiance")) {
      light.emission = s.color("radiance");
    } else {
      const fs::path image = resolve(file, expandDefines(s, "image", defines));
      light.image = static_cast<uint32_t>(scene.environments.size());
      const ReadGuard guard(image);
      scene.environments.push_back(loadEnvironment(image));
      guard.check();
      scene.files.push_back(image);
    }
  } else {
    s.fail(s.node("type"),
           "unknown type '" + type + "'; use point, spot, directional or environment");
  }
  return light;
}

// The tables of an array of tables such as [[mesh]].
std::vector<const toml::table*> tablesOf(const fs::path& file, const toml::table& root,
                                         const char* key) {
  std::vector<const toml::table*> tables;
  const toml::node* node = root.get(key);
  if (!node) return tables;
  const toml::array* array = node->as_array();
  for (size_t i = 0; array && i < array->size(); ++i) {
    if (const toml::table* t = array->get(i)->as_table()) tables.push_back(t);
  }
  if (!array || tables.size() != array->size()) {
    throw InputError(file.string() + ":" + std::to_string(node->source().begin.line) + ": '" + key +
                     "' must be written as [[" + key + "]]");
  }
  return tables;
}

const toml::table& tableOf(const fs::path& file, const toml::table& root, const char* key) {
  const toml::node* node = root.get(key);
  const toml::table* table = node ? node->as_table() : nullptr;
  if (!table) throw InputError(file, std::string("needs a [") + key + "] section; add it");
  return *table;
}

// toml++ makes a table of each dot of a.b.c.d, and takes them apart by a call for each: enough of
// them overflow the stack. It limits nested brackets itself.
void refuseDeepKeys(const fs::path& path, const std::string& text) {
  constexpr size_t kMaxDots = 100;
  size_t line = 1, dots = 0;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      dots = 0;
    } else if (c == '.' && ++dots > kMaxDots) {
      throw InputError(path.string() + ":" + std::to_string(line) + ": more than " +
                       std::to_string(kMaxDots) + " dots in a line; break the line");
    }
  }
}

toml::table parseToml(const fs::path& path) {
  if (!isRegularFile(path)) throw InputError(path, "no such file; name a scene.toml");
  const std::string text = readText(path);
  refuseDeepKeys(path, text);
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& e) {
    throw InputError(path.string() + ":" + std::to_string(e.source().begin.line) + ": " +
                     std::string(e.description()));
  }
}

}  // namespace

Scene loadScene(const fs::path& path, const Defines& defines) {
  const toml::table root = parseToml(path);
  const Section top(path, "scene", root, {"film", "camera", "mesh", "light"});

  Scene scene;
  scene.files.push_back(path);
  const Section film(path, "[film]", tableOf(path, root, "film"), {"width", "height"});
  scene.film = {film.integer("width", 1, kMaxFilmSide), film.integer("height", 1, kMaxFilmSide)};
  const Section camera(path, "[camera]", tableOf(path, root, "camera"),
                       {"position", "look_at", "forward", "up", "vertical_fov_deg"});
  readCamera(camera, {});  // refuses a bad one before the meshes are read

  ObjLoader loader(scene);
  for (const toml::table* t : tablesOf(path, root, "mesh")) {
    const Section s(path, "[[mesh]]", *t,
                    {"file", "materials", "transform", "translate", "rotate_deg", "scale"});
    const fs::path materials =
        s.has("materials") ? resolve(path, expandDefines(s, "materials", defines)) : fs::path();
    loader.load(resolve(path, expandDefines(s, "file", defines)), materials, readTransform(s));
  }
  loader.finish();
  scene.camera = readCamera(camera, scene.origin);
  for (const toml::table* t : tablesOf(path, root, "light")) {
    const Section s(
        path, "[[light]]", *t,
        {"type", "position", "direction", "intensity", "irradiance", "radiance", "image",
         "cone_deg", "falloff_deg", "angular_diameter_deg", "rotate_deg", "scale"});
    scene.lights.push_back(readLight(path, s, defines, scene));
  }
  if (scene.triangles.empty()) {
    throw InputError(path, "has no triangle; name at least one OBJ file in a [[mesh]]");
  }
  const float size = scene.bounds.diagonal();
  if (!(size >= kSmallestScene && size <= kLargestScene)) {
    std::ostringstream text;
    text << "is " << size << " units across, outside " << kSmallestScene << " to " << kLargestScene
         << ", where floats suffice; change the meshes' 'scale' and the lights";
    throw InputError(path, text.str());
  }
  scene.contentHash = hashScene(scene);
  return scene;
}

}  // namespace bnvpl
