#include "scene/scene_builder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>

#include "core/files.h"
#include "core/number_text.h"
#include "core/read_file.h"
#include "scene/material_inputs.h"
#include "scene/scene_hash.h"

namespace bnvpl {

namespace {

// Sizes of scenes that floats hold: products of four lengths must stay in range.
constexpr float kSmallestScene = 1e-6f, kLargestScene = 1e9f;

// Of an expression: operands may share operands, so that few expressions ask for very many lookups.
constexpr uint32_t kMaxLookups = 1000;

bool isFinite(const FilePoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

bool hasTexture(const Material& m) {
  if (const auto* p = std::get_if<PhongModel>(&m.model)) {
    if (p->diffuseMap != kNone || p->glossyMap != kNone) return true;
  }
  bool expression = false;
  forEachExpression(m, [&](uint32_t number) { expression |= number != kNone; });
  return expression || m.opacityMap != kNone;
}

}  // namespace

SceneBuilder::SceneBuilder(fs::path sceneFile) { scene_.files.push_back(std::move(sceneFile)); }

void SceneBuilder::setCamera(const FilePoint& position, const Camera& camera) {
  cameraPosition_ = position;
  scene_.camera = camera;
}

uint32_t SceneBuilder::addTexture(const TextureUse& use) {
  if (!isRegularFile(use.file)) {
    warn(use.file.string() + ": no such texture; the plain material colour is used");
    return kNone;
  }
  addFile(use.file);
  return textures_.add(use);
}

uint32_t SceneBuilder::addMaterial(Material material) {
  uint32_t parts = 1;
  if (const auto* mix = std::get_if<MixModel>(&material.model)) {
    for (const uint32_t part : {mix->first, mix->second}) {
      assert(part == kNone || part < scene_.materials.size());
      if (part != kNone) parts += mixParts_[part];
    }
    if (parts > kMaxLookups) {
      warn(name() + ": material '" + material.name + "' mixes too many materials; it is grey");
      material.model = DiffuseModel{};
      parts = 1;
    }
  }
  mixParts_.push_back(parts);
  scene_.materials.push_back(std::move(material));
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

uint32_t SceneBuilder::addExpression(const TextureExpression& expression) {
  uint32_t lookups = 1;
  for (const uint32_t operand : {expression.first, expression.second, expression.amount}) {
    assert(operand == kNone || operand < scene_.expressions.size());
    if (operand != kNone) lookups += lookups_[operand];
  }
  if (lookups > kMaxLookups) {
    warn(name() + ": a texture is made of more than " + std::to_string(kMaxLookups) +
         " textures; the plain material colour is used");
    return kNone;
  }
  scene_.expressions.push_back(expression);
  lookups_.push_back(lookups);
  return static_cast<uint32_t>(scene_.expressions.size() - 1);
}

uint32_t SceneBuilder::greyMaterial() {
  if (grey_ == kNone) {
    Material grey;
    grey.phong().diffuse = Vec3{0.5f};
    grey_ = addMaterial(std::move(grey));
  }
  return grey_;
}

uint32_t SceneBuilder::addEnvironment(const fs::path& image) {
  const ReadGuard guard(image);
  scene_.environments.push_back(loadEnvironment(image));
  guard.check();
  addFile(image);
  return static_cast<uint32_t>(scene_.environments.size() - 1);
}

void SceneBuilder::addLight(const LightSpec& light, const FilePoint& position) {
  scene_.lights.push_back(light);
  lightPositions_.push_back(position);
}

void SceneBuilder::addFile(const fs::path& file) {
  if (std::find(scene_.files.begin(), scene_.files.end(), file) == scene_.files.end())
    scene_.files.push_back(file);
}

void SceneBuilder::warn(const std::string& text) {
  if (warned_.insert(text).second) scene_.warnings.push_back(text);
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

size_t SceneBuilder::addMesh(const fs::path& file, Mesh mesh, const Affine& transform) {
  const Base base = addCorners(file, mesh, transform);
  const bool mirrored = transform.determinant() < 0.0;
  const auto moved = [](uint32_t index, size_t begin, size_t end) {
    return index < end - begin ? static_cast<uint32_t>(begin + index) : kNone;
  };
  size_t kept = 0, grey = 0;
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
    if (t.material == kNone) {
      t.material = greyMaterial();
      ++grey;
    }
    assert(t.material < scene_.materials.size());
    mesh.triangles[kept++] = t;
  }
  if (kept < mesh.triangles.size()) {
    warn(file.string() + ": " + std::to_string(mesh.triangles.size() - kept) +
         " triangles with missing or non-finite vertices are left out");
  }
  mesh.triangles.resize(kept);
  if (scene_.triangles.empty()) {
    scene_.triangles = std::move(mesh.triangles);
  } else {
    scene_.triangles.insert(scene_.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  }
  parts_.push_back({file, scene_.triangles.size()});
  return grey;
}

// Until here, maps hold the numbers of the pool.
void SceneBuilder::resolveTextures() {
  TexturePool::Result read = textures_.take();
  for (const std::string& problem : read.problems)
    warn(problem + "; the plain material colour is used");
  scene_.textures = std::move(read.textures);
  static_assert(TexturePool::kUnreadable == kNone);
  const auto resolve = [&](uint32_t& map) {
    if (map != kNone) map = read.indexOf.at(map);
  };
  for (Material& m : scene_.materials) {
    resolve(m.opacityMap);
    if (auto* phong = std::get_if<PhongModel>(&m.model)) {
      resolve(phong->diffuseMap);
      resolve(phong->glossyMap);
    }
  }
  for (TextureExpression& e : scene_.expressions) resolve(e.image);
}

void SceneBuilder::warnOfMissingUvs() {
  size_t next = 0;
  for (const Part& part : parts_) {
    std::vector<bool> warned(scene_.materials.size(), false);
    for (; next < part.endTriangle; ++next) {
      const Triangle& t = scene_.triangles[next];
      const Material& m = scene_.materials[t.material];
      if (warned[t.material] || !hasTexture(m)) continue;
      if (std::find(t.uv.begin(), t.uv.end(), kNone) == t.uv.end()) continue;
      warned[t.material] = true;
      warn(part.file.string() + ": material '" + m.name +
           "' has a texture but faces without texture coordinates; "
           "the plain material colour is used there");
    }
  }
}

void SceneBuilder::roundPositions() {
  FilePoint lower, upper;
  lower.fill(INFINITY);
  upper.fill(-INFINITY);
  for (const Triangle& t : scene_.triangles) {
    for (const uint32_t p : t.position) {
      for (size_t i = 0; i < 3; ++i) {
        lower[i] = std::min(lower[i], points_[p][i]);
        upper[i] = std::max(upper[i], points_[p][i]);
      }
    }
  }
  if (!scene_.triangles.empty()) scene_.origin = sceneOrigin(lower, upper);
  scene_.positions.reserve(points_.size() + 1);
  for (const FilePoint& p : points_) scene_.positions.push_back(fromOrigin(p, scene_.origin));
  points_ = {};
  scene_.camera.position = fromOrigin(cameraPosition_, scene_.origin);
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    LightSpec& light = scene_.lights[i];
    if (light.type == LightType::Point || light.type == LightType::Spot)
      light.position = fromOrigin(lightPositions_[i], scene_.origin);
  }
  if (scene_.origin != FilePoint{}) {
    std::ostringstream text;
    text.precision(15);
    text << scene_.name() << ": lies far from its origin; coordinates count from ("
         << scene_.origin[0] << ", " << scene_.origin[1] << ", " << scene_.origin[2] << ")";
    warn(text.str());
  }
}

// A triangle is of use when its normal can be computed in floats, as every ray that hits it will.
void SceneBuilder::dropUnusable() {
  size_t kept = 0, next = 0;
  for (const Part& part : parts_) {
    size_t flat = 0, extreme = 0;
    for (; next < part.endTriangle; ++next) {
      const Triangle& t = scene_.triangles[next];
      const Vec3 p0 = scene_.positions[t.position[0]], p1 = scene_.positions[t.position[1]],
                 p2 = scene_.positions[t.position[2]];
      const Vec3 normal = cross(p1 - p0, p2 - p0);
      const float length2 = lengthSquared(normal);
      if (std::isnormal(length2)) {
        scene_.triangles[kept++] = t;
      } else {
        ++(isBlack(normal) ? flat : extreme);
      }
    }
    if (flat > 0) {
      warn(part.file.string() + ": " + std::to_string(flat) +
           " triangles without area are left out");
    }
    if (extreme > 0) {
      warn(part.file.string() + ": " + std::to_string(extreme) +
           " triangles too small or too large for floats are left out; change their scale");
    }
  }
  scene_.triangles.resize(kept);
}

// Of emissive triangles that lie on each other, winding included, one stays: light sampling would
// count both, while a ray meets one.
void SceneBuilder::dropDoubledLamps() {
  std::set<std::array<float, 9>> seen;
  const auto doubled = [&](const Triangle& t) {
    if (isBlack(scene_.materials[t.material].emission)) return false;
    std::array<std::array<float, 3>, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = scene_.positions[t.position[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> key;
    for (size_t i = 0; i < 9; ++i) key[i] = corners[i / 3][i % 3];
    return !seen.insert(key).second;
  };
  const size_t dropped = std::erase_if(scene_.triangles, doubled);
  if (dropped > 0) {
    warn(scene_.name() + ": " + std::to_string(dropped) +
         " emissive triangles lie on others; one of each is left, or it would shine twice");
  }
}

void SceneBuilder::sortByMask() {
  const auto opaque = [&](const Triangle& t) { return !scene_.materials[t.material].masked(); };
  const auto firstMasked =
      std::stable_partition(scene_.triangles.begin(), scene_.triangles.end(), opaque);
  scene_.maskedBegin = static_cast<uint32_t>(firstMasked - scene_.triangles.begin());
}

void SceneBuilder::requireSize() const {
  if (scene_.triangles.empty())
    throw InputError(scene_.name() + ": has no triangle; give it a mesh that has an area");
  const float size = scene_.bounds.diagonal();
  if (size >= kSmallestScene && size <= kLargestScene) return;
  throw InputError(scene_.name() + ": is " + shortestText(size) + " units across, outside " +
                   shortestText(kSmallestScene) + " to " + shortestText(kLargestScene) +
                   ", where floats suffice; change the meshes' 'scale' and the lights");
}

Scene SceneBuilder::finish() {
  resolveTextures();
  warnOfMissingUvs();
  roundPositions();
  dropUnusable();
  dropDoubledLamps();
  sortByMask();
  for (const Triangle& t : scene_.triangles) {
    for (const uint32_t p : t.position) scene_.bounds.extend(scene_.positions[p]);
  }
  scene_.positions.push_back({});  // Embree reads 16 bytes at each vertex
  requireSize();
  if (!scene_.hasLight()) warn(scene_.name() + ": " + kNoLight);
  scene_.contentHash = hashScene(scene_);
  return std::exchange(scene_, {});
}

}  // namespace bnvpl
