#include "scene/read/gltf/views_and_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/number_text.h"

namespace bnvpl {

namespace {

constexpr double kLumensPerWatt = 683.0;

// Where the axis `d` of a light or camera points, of unit length. Their nodes' scales have no
// meaning (glTF 2.0, 3.10; KHR_lights_punctual), so that one of 0 leaves the rotations.
Vec3 directionOf(const GltfPlacement& placement, const FilePoint& d) {
  for (const Affine* a : {&placement.world, &placement.turn}) {
    const FilePoint turned = a->direction(d);
    const double length = std::hypot(turned[0], turned[1], turned[2]);
    if (length > 0.0 && std::isfinite(length))
      return fromOrigin({turned[0] / length, turned[1] / length, turned[2] / length}, {});
  }
  return fromOrigin(d, {});
}

bool isFinite(const FilePoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

FilePoint placeOf(const GltfModel& model, const GltfPlacement& placement) {
  const FilePoint place = placement.world.point({0, 0, 0});
  if (!isFinite(place)) {
    model.fail(gltfPointer("nodes", placement.node),
               "lies out of range; move it nearer to the origin");
  }
  return place;
}

// The name of a part, or its JSON pointer, for messages.
std::string nameOrPointer(const std::string& name, const char* array, size_t i) {
  return name.empty() ? gltfPointer(array, i).insert(0, "#") : "'" + name + "'";
}

// A film with the camera's aspect and a shorter side of 540 pixels; 960 x 540 without an aspect.
Film filmOf(double aspect) {
  constexpr uint32_t kShorter = 540;
  constexpr double kUsual = 16.0 / 9.0;
  if (!(aspect > 0.0)) aspect = kUsual;
  const auto longer = [](double ratio) {
    return std::min(kMaxFilmSide, static_cast<uint32_t>(std::lround(kShorter * ratio)));
  };
  return aspect >= 1.0 ? Film{longer(aspect), kShorter} : Film{kShorter, longer(1.0 / aspect)};
}

float radians(double angle) { return static_cast<float>(angle); }

// The rim lies between the inner and outer cone. Its profile is that of spot lights in scene.toml.
void setCone(const GltfModel& model, const tinygltf::SpotLight& spot, LightSpec& light) {
  if (spot.innerConeAngle > spot.outerConeAngle) {
    model.warn("a spot light's innerConeAngle exceeds its outerConeAngle, which is used for both");
  }
  constexpr double kMin = 1e-4;
  const double outer = std::clamp(spot.outerConeAngle, kMin, std::numbers::pi / 2);
  light.coneRad = radians(outer);
  light.falloffRad =
      std::min(light.coneRad, radians(std::max(0.0, outer - std::max(0.0, spot.innerConeAngle))));
}

}  // namespace

void addGltfCamera(const GltfModel& model, const GltfPlacement& placement, SceneBuilder& builder) {
  const tinygltf::Node& node = model.parts().nodes[placement.node];
  if (node.camera < 0) return;
  const tinygltf::Camera& from = model.parts().cameras[static_cast<size_t>(node.camera)];
  const std::string& name = node.name.empty() ? from.name : node.name;
  const std::string shown = nameOrPointer(name, "cameras", static_cast<size_t>(node.camera));
  if (from.type != "perspective") {
    model.warn("camera " + shown + " is " + from.type + ", which is not rendered; it is left out");
    return;
  }
  Camera camera;
  camera.forward = directionOf(placement, {0, 0, -1});
  const Vec3 up = directionOf(placement, {0, 1, 0});
  const Vec3 right = cross(camera.forward, up);
  camera.right = length(right) > 1e-6f ? normalize(right) : Frame(camera.forward).s;
  camera.up = cross(camera.right, camera.forward);
  camera.verticalFovRad = radians(from.perspective.yfov);
  const Film film = filmOf(from.perspective.aspectRatio);
  if (std::max(film.width, film.height) == kMaxFilmSide) {
    model.warn("camera " + shown + ": a film of aspectRatio " +
               shortestText(from.perspective.aspectRatio) + " is cut to " +
               std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels");
  }
  builder.addCamera(name, placeOf(model, placement), camera, film);
}

void addGltfLight(const GltfModel& model, const GltfPlacement& placement, SceneBuilder& builder) {
  const auto& extensions = model.parts().nodes[placement.node].extensions;
  const auto it = extensions.find("KHR_lights_punctual");
  if (it == extensions.end()) return;
  const auto index = static_cast<size_t>(it->second.Get("light").GetNumberAsInt());
  const tinygltf::Light& from = model.parts().lights[index];
  LightSpec light;
  light.name = model.parts().nodes[placement.node].name;
  if (light.name.empty()) light.name = from.name;
  for (size_t i = 0; i < 3; ++i) {
    const double colour = from.color.size() == 3 ? from.color[i] : 1.0;
    light.emission[i] = static_cast<float>(colour * from.intensity / kLumensPerWatt);
  }
  light.direction = directionOf(placement, {0, 0, -1});
  if (from.type == "point") {
    light.type = LightType::Point;
  } else if (from.type == "spot") {
    light.type = LightType::Spot;
    setCone(model, from.spot, light);
  } else if (from.type == "directional") {
    light.type = LightType::Directional;
  } else {
    model.warn("a light of unknown type '" + from.type + "' is left out");
    return;
  }
  if (from.range > 0.0) {
    model.warn(
        "the range of lights is ignored: light falls off with the square of the distance "
        "alone");
  }
  if (isBlack(light.emission)) return;
  builder.addLight(light, placeOf(model, placement));
}

}  // namespace bnvpl
