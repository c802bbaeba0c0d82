// Lights of a scene.toml that are surfaces: triangles of a black material that emits.
#include <cmath>
#include <numbers>
#include <set>

#include "scene/read/toml/toml_lights.h"
#include "scene/shapes/quadrics.h"

namespace bnvpl {

namespace {

constexpr double kMinLampSide = 1e-9, kMaxLampSide = 1e9;
constexpr double kWholeTurn = 2.0 * std::numbers::pi;

FilePoint crossed(const FilePoint& a, const FilePoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The transform from a shape that faces +z, with y up, to one at `position` that faces `forward`.
Affine facing(const TomlSection& s, const FilePoint& position, const FilePoint& forward) {
  const bool given = s.has("up");
  FilePoint right;
  double length = 0.0;
  const auto tryUp = [&](const FilePoint& up) {
    right = crossed(up, forward);
    length = std::hypot(right[0], right[1], right[2]);
    return length > 1e-6 * std::hypot(up[0], up[1], up[2]);
  };
  if (!tryUp(given ? s.point("up") : FilePoint{0, 1, 0})) {
    if (given) s.fail(s.node("up"), "'up' is parallel to the light's direction; choose another");
    tryUp({0, 0, -1});
  }
  for (double& x : right) x /= length;
  const FilePoint up = crossed(forward, right);
  Affine out;
  for (size_t i = 0; i < 3; ++i) out.m[i] = {right[i], up[i], forward[i], position[i]};
  return out;
}

// Radiance in W/(m2 sr) of a surface that sends out `power` W over `areaM2` of its sides.
Vec3 radianceOf(const TomlSection& s, double areaM2) {
  if (s.has("radiance") == s.has("power")) s.fail("needs exactly one of 'power' and 'radiance'");
  if (s.has("radiance")) return s.color("radiance");
  const Vec3 radiance = s.color("power") * static_cast<float>(1.0 / (std::numbers::pi * areaM2));
  if (!isFinite(radiance))
    s.fail(s.node("power"), "'power' is more than so small a light can have");
  return radiance;
}

double side(const TomlSection& s, const char* key) {
  return s.number(key, kMinLampSide, kMaxLampSide);
}

}  // namespace

bool readTomlAreaLight(const fs::path& file, const TomlSection& s, const std::string& type,
                       size_t number, SceneBuilder& builder) {
  std::set<std::string> keys{"name", "type", "position", "power", "radiance", "group"};
  const bool sphere = type == "sphere", disk = type == "disk";
  if (!sphere && !disk && type != "rectangle") return false;
  if (!sphere) keys.insert({"direction", "look_at", "up", "sides"});
  if (type == "rectangle") keys.insert({"width", "height"});
  if (sphere || disk) keys.insert("radius");
  s.requireOnly("a " + type + " light", keys);

  MeshData mesh;
  double area = 0.0;
  if (type == "rectangle") {
    const double width = side(s, "width"), height = side(s, "height");
    mesh = rectangleMesh(width, height);
    area = width * height;
  } else {
    const double r = side(s, "radius");
    mesh = sphere ? sphereMesh(r, -r, r, kWholeTurn) : diskMesh(r, 0.0, 0.0, kWholeTurn);
    area = std::numbers::pi * r * r * (sphere ? 4.0 : 1.0);
  }
  Material m;
  m.name = s.has("name") ? s.newName({}) : type + " light " + std::to_string(number);
  m.model = DiffuseModel{Colour(Vec3(0))};
  m.twoSidedEmission = s.has("sides") && s.integer("sides", 1, 2) == 2;
  m.lightGroup = tomlLightGroup(s, builder);
  m.emission = radianceOf(s, m.twoSidedEmission ? 2.0 * area : area);
  const FilePoint position = s.place("position");
  Affine place;
  for (size_t i = 0; i < 3; ++i) place.m[i][3] = position[i];
  if (!sphere) place = facing(s, position, tomlDirection(s, position));
  const ObjectRun object{0, builder.addObject(m.name)};
  const fs::path named = file.string() + "#" + m.name;
  const uint32_t material = builder.addOwnMaterial(std::move(m));
  for (Triangle& t : mesh.triangles) t.material = material;
  builder.addMesh(named, {mesh.positions, mesh.normals, mesh.uvs, mesh.triangles, {object}}, place);
  return true;
}

}  // namespace bnvpl
