// The part of SceneBuilder that places files which other files include.
#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "scene/builder/scene_builder.h"

namespace bnvpl {

namespace {

constexpr size_t kMaxIncludeDepth = 16, kMaxIncludes = 10000, kMaxPlaces = size_t{1} << 26;

// The unit vector of a transformed direction; `otherwise` where the transform flattens it.
Vec3 turned(const Affine& place, Vec3 d, Vec3 otherwise) {
  const FilePoint to = place.direction({d.x, d.y, d.z});
  const double length = std::hypot(to[0], to[1], to[2]);
  if (!(length > 0.0) || !std::isfinite(length)) return otherwise;
  return fromOrigin({to[0] / length, to[1] / length, to[2] / length}, {});
}

// Whether the transform turns about +y alone, apart from scaling and moving.
bool turnsAboutY(const Affine& place) {
  const auto& m = place.m;
  const double size = std::cbrt(std::fabs(place.determinant()));
  const auto small = [&](double x) { return std::fabs(x) <= 1e-9 * size; };
  return place.determinant() > 0.0 && small(m[0][1]) && small(m[1][0]) && small(m[1][2]) &&
         small(m[2][1]) && small(m[0][0] - m[2][2]) && small(m[0][2] + m[2][0]);
}

}  // namespace

std::string SceneBuilder::whyNotInclude(const fs::path& file) const {
  const fs::path real = realPath(file);
  const auto isThis = [&](const fs::path& other) { return realPath(other) == real; };
  if (isThis(scene_.files.front()) || std::ranges::any_of(includes_, isThis, &Include::file))
    return "includes itself; remove one of the [[mesh]]";
  if (includes_.size() == kMaxIncludeDepth)
    return "lies " + std::to_string(kMaxIncludeDepth) + " files deep; include it further out";
  return includeCount_ < kMaxIncludes ? "" : "is one of more than 10000 includes; use instances";
}

void SceneBuilder::beginInclude(const fs::path& file, const Affine& place,
                                std::vector<Place> instances) {
  addFile(file);
  ++includeCount_;
  const Affine outer = place_;
  place_ = !instances.empty() ? place : including() ? outer * place : place;
  includes_.push_back({file, outer, std::move(instances), replacements_, emissions_, placed_.size(),
                       scene_.lights.size(), scene_.views.size()});
}

void SceneBuilder::endInclude() {
  const Include done = std::move(includes_.back());
  includes_.pop_back();
  place_ = done.outer;
  replacements_ = done.replacements;
  emissions_ = done.emissions;
  if (done.instances.empty()) return;
  dropCameras(done.views);
  const auto from = [](const auto& all, size_t first) {
    return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first), all.end());
  };
  const std::vector<Placed> meshes = from(placed_, done.placed);
  const std::vector<LightSpec> lights = from(scene_.lights, done.lights);
  const std::vector<FilePoint> positions = from(lightPositions_, done.lights);
  placed_.resize(done.placed);
  scene_.lights.resize(done.lights);
  lightPositions_.resize(done.lights);
  const auto isEverywhere = [](const LightSpec& light) {
    return light.type == LightType::Environment || light.type == LightType::Directional;
  };
  const auto most = static_cast<double>(std::max(meshes.size(), lights.size()));
  if (most * static_cast<double>(done.instances.size()) > double{kMaxPlaces}) {
    throw InputError(done.file, "its meshes or lights stand in more than " +
                                    std::to_string(kMaxPlaces) +
                                    " places; list fewer [[mesh.instance]]");
  }
  for (size_t k = 0; k < done.instances.size(); ++k) {
    const auto& [toScene, object] = done.instances[k];
    for (const Placed& p : meshes)
      addInstance(p.prototype, toScene * p.toWorld, object == kNone ? p.object : object);
    for (size_t i = 0; i < lights.size(); ++i) {
      if (k > 0 && isEverywhere(lights[i])) continue;  // it would shine once more
      LightSpec light = lights[i];
      FilePoint position = positions[i];
      placeLight(toScene, light, position);
      addLight(light, position);
    }
  }
  if (done.instances.size() > 1 && std::ranges::any_of(lights, isEverywhere))
    warn(done.file.string() + ": its skies and suns shine once, as in its first place");
}

void SceneBuilder::addInstance(uint32_t prototype, const Affine& toWorld, uint32_t object) {
  placed_.push_back({prototype, including() ? place_ * toWorld : toWorld, object});
}

void SceneBuilder::placeCamera(const Affine& place, Camera& camera, FilePoint& position) const {
  position = place.point(position);
  const auto stretch = [&](Vec3 d) {
    const FilePoint to = place.direction({double{d.x}, double{d.y}, double{d.z}});
    return std::hypot(to[0], to[1], to[2]);
  };
  if (camera.hasLens()) {  // an oval lens becomes a circle of the same area
    const double radius = double{camera.lensRadius} *
                          std::sqrt(stretch(camera.right) * stretch(camera.up)),
                 focus = double{camera.focusDistance} * stretch(camera.forward);
    if (!(radius <= kMaxLensLength && focus >= kMinFocusDistance && focus <= kMaxLensLength))
      throw InputError(name() + ": a [[mesh]] scales a camera's lens beyond 1e9; scale it less");
    camera.lensRadius = static_cast<float>(radius);
    camera.focusDistance = static_cast<float>(focus);
  }
  const bool mirrored = camera.isMirrored();
  camera.forward = turned(place, camera.forward, camera.forward);
  const Vec3 up = turned(place, camera.up, camera.up);
  const Vec3 right = cross(camera.forward, up);
  camera.right = length(right) > 1e-6f ? normalize(right) : camera.right;
  camera.up = cross(camera.right, camera.forward);
  if (mirrored != (place.determinant() < 0.0)) camera.right = -camera.right;
}

// Radiance and irradiance stay as they are; the intensity of a point grows with the area of what it
// lights.
void SceneBuilder::placeLight(const Affine& place, LightSpec& light, FilePoint& position) {
  position = place.point(position);
  light.direction = turned(place, light.direction, light.direction);
  if (light.pointOrSpot()) {
    const double size = std::cbrt(std::fabs(place.determinant()));
    light.emission *= static_cast<float>(size * size);
    if (!isFinite(light.emission))
      throw InputError(name() +
                       ": a [[mesh]] scales a light beyond what numbers hold; scale it less");
  }
  if (light.type != LightType::Environment || light.image == kNone) return;
  if (turnsAboutY(place)) {
    light.rotateRad += static_cast<float>(std::atan2(place.m[0][2], place.m[0][0]));
  } else {
    warn(name() +
         ": an included environment image turns only about +y; it stays as it is in its "
         "file");
  }
}

}  // namespace bnvpl
