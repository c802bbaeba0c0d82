// The part of SceneBuilder that knows which triangles are part of which object.
#include <algorithm>
#include <cassert>

#include "scene/builder/scene_builder.h"

namespace bnvpl {

std::string onOneLine(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '_');
  return name;
}

uint32_t SceneBuilder::addObject(std::string name) {
  name = onOneLine(std::move(name));
  const auto [it, isNew] = objectNumbers_.try_emplace(name, static_cast<uint32_t>(objects_.size()));
  if (isNew) objects_.push_back(std::move(name));
  return it->second;
}

uint32_t SceneBuilder::surfaceOf(Surface surface) {
  assert(surface.material == kNone || surface.material < scene_.materials.size());
  assert(surface.object < objects_.size());
  const auto [it, isNew] =
      surfaceNumbers_.try_emplace(surface, static_cast<uint32_t>(surfaces_.size()));
  if (isNew) surfaces_.push_back(surface);
  return it->second;
}

// Replaces the materials of the triangles by surfaces.
void SceneBuilder::giveSurfaces(const fs::path& file, Mesh& mesh) {
  if (mesh.objects.empty()) mesh.objects.push_back({0, addObjectOf(file)});
  auto run = mesh.objects.begin();
  Surface last{kNone, kNone};
  uint32_t number = kNone;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    while (run + 1 != mesh.objects.end() && (run + 1)->firstTriangle <= i) ++run;
    Triangle& t = mesh.triangles[i];
    if (const Surface here{t.material, run->object}; here != last) {
      number = surfaceOf(here);
      last = here;
    }
    t.material = number;
  }
}

// The object that stands for a prototype whose instances are all objects of their own: that of the
// first. kNone if one is not.
uint32_t SceneBuilder::objectOfAll(const std::vector<Placed>& uses) {
  uint32_t first = kNone;
  for (const Placed& p : uses) {
    if (p.object == kNone) return kNone;
    if (first == kNone) first = p.object;
  }
  return first;
}

// Gives triangles their materials again, and numbers the objects that have triangles in their
// order.
void SceneBuilder::listObjects() {
  std::vector<uint32_t> numbers(objects_.size(), kNone);
  const auto listed = [&](uint32_t object) {
    uint32_t& number = numbers[object];
    if (number == kNone) {
      number = static_cast<uint32_t>(scene_.objectNames.size());
      scene_.objectNames.push_back(objects_[object]);
    }
    return number;
  };
  uint32_t last = kNone;
  for (uint32_t i = 0; i < scene_.triangles.size(); ++i) {
    Triangle& t = scene_.triangles[i];
    const Surface& surface = surfaces_[t.material];
    if (surface.object != last) scene_.objectRuns.push_back({i, listed(surface.object)});
    last = surface.object;
    t.material = surface.material;
  }
  for (ObjectTriangle& face : scene_.cutFaces) {
    const Surface& surface = surfaces_[face.triangle.material];
    face.object = listed(surface.object);
    face.triangle.material = surface.material;
  }
  for (uint32_t& object : scene_.instanceObjects) {
    if (object != kNone) object = listed(object);
  }
}

}  // namespace bnvpl
