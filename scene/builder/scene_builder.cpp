#include "scene/builder/scene_builder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <unordered_map>

namespace bnvpl {

namespace {

// Maximum number of emissive triangles of one mesh over all its instances, each of which is stored.
constexpr size_t kMaxLamps = size_t{1} << 27;

bool isFinite(const FilePoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

}  // namespace

SceneBuilder::SceneBuilder(fs::path sceneFile, OnWarning onWarning)
    : onWarning_(std::move(onWarning)) {
  addFile(sceneFile);
}

void SceneBuilder::changeFilm(const std::function<Film(const Film&)>& changed, size_t first) {
  if (!including() || scene_.views.size() == first) scene_.film = changed(scene_.film);
  for (size_t i = first; i < scene_.views.size(); ++i)
    scene_.views[i].film = changed(scene_.views[i].film);
}

void SceneBuilder::dropCameras(size_t first) {
  scene_.views.resize(first);
  viewPositions_.resize(first);
}

void SceneBuilder::setCamera(const FilePoint& position, const Camera& camera) {
  dropCameras(0);
  addCamera("", position, camera, scene_.film);
}

void SceneBuilder::addCamera(const std::string& name, const FilePoint& position,
                             const Camera& camera, const Film& film) {
  scene_.views.push_back({name, camera, film});
  viewPositions_.push_back(position);
  if (including()) placeCamera(place_, scene_.views.back().camera, viewPositions_.back());
}

std::optional<uint32_t> SceneBuilder::lightGroup(const std::string& name) {
  std::vector<std::string>& groups = scene_.lightGroups;
  const auto known = std::ranges::find(groups, name);
  if (known != groups.end()) return static_cast<uint32_t>(known - groups.begin());
  if (groups.size() == kMaxLightGroups) return {};
  groups.push_back(name);
  return static_cast<uint32_t>(groups.size() - 1);
}

void SceneBuilder::addLight(const LightSpec& light, const FilePoint& position) {
  scene_.lights.push_back(light);
  scene_.lights.back().name = onOneLine(light.name);
  lightPositions_.push_back(position);
  if (including()) placeLight(place_, scene_.lights.back(), lightPositions_.back());
}

void SceneBuilder::addFile(const fs::path& file) {
  if (fileNames_.insert(file.native()).second) scene_.files.push_back(file);
}

void SceneBuilder::warn(const std::string& text) {
  if (!warned_.insert(text).second) return;
  scene_.warnings.push_back(text);
  if (onWarning_) onWarning_(text);
}

SceneBuilder::Base SceneBuilder::addCorners(const fs::path& file, const Mesh& mesh,
                                            const Affine& transform) {
  const Base base{points_.size(), scene_.normals.size(), scene_.uvs.size()};
  const size_t vertices = mesh.positions.size() / 3, normals = mesh.normals.size() / 3,
               uvs = mesh.uvs.size() / 2;
  if (std::max({base.position + vertices, base.normal + normals, base.uv + uvs}) >= kNone)
    throw InputError(file, "brings the scene to more than 2^32 - 2 vertices; simplify the mesh");
  const auto triple = [](std::span<const double> of, size_t i) {
    return FilePoint{of[3 * i], of[3 * i + 1], of[3 * i + 2]};
  };
  for (size_t i = 0; i < vertices; ++i)
    points_.push_back(transform.point(triple(mesh.positions, i)));
  for (size_t i = 0; i < normals; ++i)
    scene_.normals.push_back(transform.normal(triple(mesh.normals, i)));
  for (size_t i = 0; i < uvs; ++i) {
    scene_.uvs.push_back(
        {static_cast<float>(mesh.uvs[2 * i]), static_cast<float>(mesh.uvs[2 * i + 1])});
  }
  return base;
}

void SceneBuilder::recordMesh(const std::string& name, size_t triangles) {
  const auto [it, isNew] = meshOfName_.try_emplace(name, scene_.meshes.size());
  if (isNew) scene_.meshes.push_back({name, triangles, 0});
  ++scene_.meshes[it->second].instances;
}

uint32_t SceneBuilder::beginPrototype() {
  open_ = static_cast<uint32_t>(prototypes_.size());
  prototypes_.emplace_back();
  return open_;
}

size_t SceneBuilder::addMesh(const fs::path& file, Mesh mesh, const Affine& transform) {
  const auto grey = std::ranges::count(mesh.triangles, kNone, &Triangle::material);
  giveSurfaces(file, mesh);
  const bool inWorld = open_ == kNone;
  const auto isInstanced = [](const Include& include) { return !include.instances.empty(); };
  if (inWorld && std::ranges::none_of(includes_, isInstanced))
    return addPart(file, std::move(mesh), including() ? place_ * transform : transform, kNone);
  if (inWorld) addInstance(beginPrototype(), {});
  const auto all = [](std::span<const double> s) { return std::vector(s.begin(), s.end()); };
  prototypes_[open_].push_back({file, all(mesh.positions), all(mesh.normals), all(mesh.uvs),
                                std::move(mesh.triangles), transform});
  if (inWorld) endPrototype();
  return static_cast<size_t>(grey);
}

size_t SceneBuilder::addPart(const fs::path& file, Mesh mesh, const Affine& transform,
                             uint32_t object) {
  recordMesh(file.string(), mesh.triangles.size());
  const Base base = addCorners(file, mesh, transform);
  const bool mirrored = transform.determinant() < 0.0;
  const auto moved = [](uint32_t index, size_t begin, size_t end) {
    return index < end - begin ? static_cast<uint32_t>(begin + index) : kNone;
  };
  uint32_t given = kNone, kept = kNone;  // a surface of the mesh, and what it is in the scene
  size_t usableCount = 0, grey = 0;
  for (Triangle t : mesh.triangles) {
    if (mirrored) {
      for (auto* corners : {&t.position, &t.normal, &t.uv}) std::swap((*corners)[0], (*corners)[2]);
    }
    bool usable = true;
    for (size_t k = 0; k < 3; ++k) {
      t.position[k] = moved(t.position[k], base.position, points_.size());
      t.normal[k] = moved(t.normal[k], base.normal, scene_.normals.size());
      t.uv[k] = moved(t.uv[k], base.uv, scene_.uvs.size());
      if (t.normal[k] != kNone && isBlack(scene_.normals[t.normal[k]])) t.normal[k] = kNone;
      usable = usable && t.position[k] != kNone && isFinite(points_[t.position[k]]);
    }
    if (!usable) continue;
    if (t.material != given) {
      given = t.material;
      const auto [material, own] = surfaces_[given];
      kept = surfaceOf(
          {material == kNone ? greyMaterial() : material, object == kNone ? own : object});
    }
    grey += materialNumber(t) == kNone;
    t.material = kept;
    mesh.triangles[usableCount++] = t;
  }
  if (usableCount < mesh.triangles.size()) {
    warn(file.string() + ": " + std::to_string(mesh.triangles.size() - usableCount) +
         " triangles with missing or non-finite vertices are left out");
  }
  mesh.triangles.resize(usableCount);
  if (scene_.triangles.empty()) {
    scene_.triangles = std::move(mesh.triangles);
  } else {
    scene_.triangles.insert(scene_.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  }
  parts_.push_back({file, scene_.triangles.size(), points_.size(), shared_});
  return grey;
}

// The mesh of some of its triangles, with the vertices that they use alone.
SceneBuilder::KeptMesh SceneBuilder::KeptMesh::part(std::vector<Triangle> of) const {
  KeptMesh out{file, {}, {}, {}, std::move(of), transform};
  const auto take = [&](const std::vector<double>& from, size_t each, std::vector<double>& to,
                        std::array<uint32_t, 3> Triangle::*corners) {
    std::unordered_map<uint32_t, uint32_t> numbers;
    for (Triangle& t : out.triangles) {
      for (uint32_t& corner : t.*corners) {
        if (corner >= from.size() / each) continue;  // none
        const auto [it, isNew] = numbers.try_emplace(corner, uint32_t(to.size() / each));
        if (isNew) to.insert(to.end(), &from[each * corner], &from[each * corner] + each);
        corner = it->second;
      }
    }
  };
  take(positions, 3, out.positions, &Triangle::position);
  take(normals, 3, out.normals, &Triangle::normal);
  take(uvs, 2, out.uvs, &Triangle::uv);
  return out;
}

// Stores a mesh in its prototype. Emissive triangles go to the world instead, once for each
// instance.
void SceneBuilder::shareMesh(const KeptMesh& kept, uint32_t prototype,
                             const std::vector<Placed>& uses) {
  std::vector<Triangle> rest, lamps;
  for (const Triangle& t : kept.triangles) {
    const bool lamp = materialNumber(t) != kNone && !isBlack(materialOf(t).emission);
    (lamp ? lamps : rest).push_back(t);
  }
  if (lamps.size() * uses.size() > kMaxLamps) {
    throw InputError(kept.file, "is placed so often that its lamps are more than " +
                                    std::to_string(kMaxLamps) + " triangles; place it less often");
  }
  if (!lamps.empty()) {
    const KeptMesh shining = kept.part(std::move(lamps));
    for (const Placed& p : uses)
      addPart(kept.file, shining.mesh(shining.triangles), p.toWorld * kept.transform, p.object);
  }
  if (rest.empty()) return;
  shared_ = prototype;
  addPart(kept.file, kept.mesh(std::move(rest)), kept.transform, objectOfAll(uses));
  shared_ = kNone;
  scene_.meshes[meshOfName_.at(kept.file.string())].instances += uses.size() - 1;
}

void SceneBuilder::placePrototypes() {
  open_ = kNone;
  std::vector<std::vector<Placed>> uses(prototypes_.size());
  for (const Placed& p : placed_) uses[p.prototype].push_back(p);
  const auto unusable = [](const Placed& p) {
    const double volume = std::fabs(p.toWorld.determinant());
    return !(volume > 0.0) || !std::isfinite(volume);
  };
  for (std::vector<Placed>& several : uses) {
    if (several.size() < 2) continue;
    for (size_t left = std::erase_if(several, unusable); left > 0; --left)
      warn(name() + ": an instance without volume, or beyond what floats hold, is left out");
  }
  for (uint32_t p = 0; p < prototypes_.size(); ++p) {
    for (const KeptMesh& kept : prototypes_[p]) {
      if (uses[p].size() > 1) shareMesh(kept, p, uses[p]);
      if (uses[p].size() != 1) continue;
      const Placed& placed = uses[p].front();
      addPart(kept.file, kept.mesh(kept.triangles), placed.toWorld * kept.transform, placed.object);
    }
    prototypes_[p] = {};
  }
  std::erase_if(placed_,
                [&](const Placed& p) { return uses[p.prototype].size() == 1 || unusable(p); });
}

}  // namespace bnvpl
