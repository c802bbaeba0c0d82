// The part of SceneBuilder that makes a sound scene from what was added: finish().
#include <algorithm>
#include <cmath>
#include <map>

#include "core/number_text.h"
#include "scene/builder/coplanar_lamps.h"
#include "scene/builder/lights_in_surfaces.h"
#include "scene/builder/scene_builder.h"
#include "scene/scene_hash.h"

namespace bnvpl {

namespace {

// Limits on the size of a scene: products of four lengths must stay in the range of floats.
constexpr float kMinSceneSize = 1e-6f, kMaxSceneSize = 1e9f;

// A camera above and to the right that looks at the middle.
Camera cameraThatSees(const Bounds& bounds, const Film& film) {
  Camera c;
  c.verticalFovRad = 0.7f;
  c.forward = normalize(Vec3{-1.0f, -0.6f, -1.2f});
  c.right = normalize(cross(c.forward, {0, 1, 0}));
  c.up = cross(c.right, c.forward);
  const float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
  const float half = aspect < 1.0f ? std::atan(aspect * std::tan(0.5f * c.verticalFovRad))
                                   : 0.5f * c.verticalFovRad;
  const float distance = 0.5f * bounds.diagonal() / std::sin(half);
  c.position = bounds.center() - distance * c.forward;
  return c;
}

}  // namespace

// Moves opaque triangles to the front of the world and of each prototype.
void SceneBuilder::sortByMask() {
  const auto opaque = [&](const Triangle& t) { return !materialOf(t).masked(); };
  const auto begin = scene_.triangles.begin();
  const auto sort = [&](size_t from, size_t to) {
    const auto masked = std::stable_partition(begin + static_cast<std::ptrdiff_t>(from),
                                              begin + static_cast<std::ptrdiff_t>(to), opaque);
    return static_cast<uint32_t>(masked - begin);
  };
  scene_.maskedBegin = sort(0, scene_.worldEnd());
  for (Prototype& p : scene_.prototypes) p.maskedBegin = sort(p.begin, p.end);
}

// Moves the triangles of prototypes behind those of the world and creates the instances.
void SceneBuilder::placeInstances() {
  if (placed_.empty()) return;
  std::vector<Triangle> world;
  std::map<uint32_t, std::vector<Triangle>> shared;
  size_t next = 0;
  for (const Part& part : parts_) {
    auto& to = part.prototype == kNone ? world : shared[part.prototype];
    for (; next < part.endTriangle; ++next) to.push_back(scene_.triangles[next]);
  }
  scene_.triangles = std::move(world);
  std::map<uint32_t, uint32_t> numberOf;
  for (const auto& [prototype, triangles] : shared) {
    if (triangles.empty()) continue;
    numberOf[prototype] = static_cast<uint32_t>(scene_.prototypes.size());
    const auto begin = static_cast<uint32_t>(scene_.triangles.size());
    scene_.triangles.insert(scene_.triangles.end(), triangles.begin(), triangles.end());
    scene_.prototypes.push_back({begin, begin, static_cast<uint32_t>(scene_.triangles.size())});
  }
  for (const Placed& p : placed_) {
    const auto found = numberOf.find(p.prototype);
    if (found == numberOf.end()) continue;
    Instance instance{found->second, p.toWorld.determinant() < 0.0, {}, {}};
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c)
        instance.toWorld[4 * r + c] =
            static_cast<float>(p.toWorld.m[r][c] - (c == 3 ? scene_.origin[r] : 0.0));
    }
    const double scale = std::cbrt(std::fabs(p.toWorld.determinant()));
    for (size_t c = 0; c < 3; ++c) {
      FilePoint axis{};
      axis[c] = 1.0 / (scale * scale);
      const FilePoint column = p.toWorld.cofactors(axis);
      for (size_t r = 0; r < 3; ++r)
        instance.normalToWorld[3 * r + c] =
            static_cast<float>(instance.mirrored ? -column[r] : column[r]);
    }
    scene_.instances.push_back(instance);
    scene_.instanceObjects.push_back(p.object);
  }
  if (scene_.instances.empty() && !scene_.prototypes.empty()) {
    scene_.triangles.resize(scene_.worldEnd());
    scene_.prototypes.clear();
  }
}

// Instances extend the bounds by the transformed corners of their prototype's box.
void SceneBuilder::extendBounds() {
  std::vector<Bounds> boxes(scene_.prototypes.size());
  const Strays strays = strays_.from(scene_.origin);
  const auto place = [&](uint32_t t, size_t c) {
    const Vec3 p = scene_.corner(t, c);
    return FilePoint{p.x, p.y, p.z};
  };
  Bounds near;
  const auto extend = [&](Bounds& box, uint32_t begin, uint32_t end) {
    for (uint32_t t = begin; t < end; ++t) {
      const Corners corners{place(t, 0), place(t, 1), place(t, 2)};
      if (strays.isNear(corners))
        for (size_t c = 0; c < 3; ++c) near.extend(scene_.corner(t, c));
      if (strays.count() > 0 && strays.has(corners)) continue;
      for (size_t c = 0; c < 3; ++c) box.extend(scene_.corner(t, c));
    }
  };
  extend(scene_.bounds, 0, scene_.worldEnd());
  if (scene_.instances.empty()) scene_.nearSize = near.diagonal();
  for (size_t p = 0; p < boxes.size(); ++p)
    extend(boxes[p], scene_.prototypes[p].begin, scene_.prototypes[p].end);
  for (const Instance& i : scene_.instances) scene_.bounds.extend(i.box(boxes[i.prototype]));
}

void SceneBuilder::requirePlace(const FilePoint& p, const char* what) const {
  for (const double x : p) {
    if (std::fabs(x) <= kMaxCoordinate) continue;
    throw InputError(name() + ": " + what + " lies at " + shortestText(x) + ", beyond " +
                     shortestText(kMaxCoordinate) + "; move it towards the scene");
  }
}

void SceneBuilder::placeViews() {
  for (const FilePoint& p : viewPositions_) requirePlace(p, "a camera");
  for (size_t i = 0; i < scene_.views.size(); ++i)
    scene_.views[i].camera.position = fromOrigin(viewPositions_[i], scene_.origin);
  if (scene_.views.empty()) {
    scene_.views.push_back({"", cameraThatSees(scene_.bounds, scene_.film), scene_.film});
    warn(scene_.name() + ": has no camera; one is placed that sees the whole scene");
  }
  scene_.camera = scene_.views.front().camera;
  scene_.film = scene_.views.front().film;
}

void SceneBuilder::requireSize() const {
  if (scene_.triangles.empty())
    throw InputError(scene_.name() + ": has no triangle; give it a mesh that has an area");
  if (strays_.furthest() > double{kMaxSceneSize}) {
    throw InputError(scene_.name() + ": has a triangle that lies " +
                     distanceText(strays_.furthest()) + " away from the others, beyond " +
                     shortestText(kMaxSceneSize) + "; remove it");
  }
  const float size = scene_.bounds.diagonal();
  if (size > kMaxSceneSize && scene_.nearSize <= kMaxSceneSize) {
    throw InputError(scene_.name() + ": has a triangle that reaches " + shortestText(size) +
                     " away from the others, beyond " + shortestText(kMaxSceneSize) +
                     "; mend or remove it");
  }
  if (size >= kMinSceneSize && size <= kMaxSceneSize) return;
  throw InputError(scene_.name() + ": is " + shortestText(size) + " units across, outside " +
                   shortestText(kMinSceneSize) + " to " + shortestText(kMaxSceneSize) +
                   ", where floats suffice; change the meshes' 'scale' and the lights");
}

// Makes the numbers of light groups independent of the order in which files name them.
void SceneBuilder::sortLightGroups() {
  const std::vector<std::string> named = scene_.lightGroups;
  std::ranges::sort(scene_.lightGroups.begin() + 1, scene_.lightGroups.end());
  const auto renumber = [&](uint32_t& group) {
    group = static_cast<uint32_t>(std::ranges::find(scene_.lightGroups, named[group]) -
                                  scene_.lightGroups.begin());
  };
  for (Material& m : scene_.materials) renumber(m.lightGroup);
  for (LightSpec& l : scene_.lights) renumber(l.group);
}

Scene SceneBuilder::finish() {
  placePrototypes();
  resolveTextures();
  foldConstants();
  warnOfMissingUvs();
  findStrays();
  roundPositions();
  dropUnusable();
  placeInstances();
  dropDoubledLamps();
  sortByMask();
  listObjects();
  sortLightGroups();
  extendBounds();
  for (const std::string& warning : liftCoplanarLamps(scene_)) warn(warning);
  scene_.positions.push_back({});  // Embree reads 16 bytes at each vertex
  requireSize();
  if (const std::string warning = lightsInSurfaces(scene_); !warning.empty()) warn(warning);
  placeViews();
  if (!scene_.hasLight()) warn(scene_.noLight());
  scene_.contentHash = hashScene(scene_);
  return std::exchange(scene_, {});
}

}  // namespace bnvpl
