#include "scene/scene_builder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <sstream>

#include "core/files.h"
#include "core/number_text.h"
#include "core/read_file.h"
#include "scene/coplanar_lamps.h"
#include "scene/material_inputs.h"
#include "scene/scene_hash.h"

namespace bnvpl {

namespace {

// Limits on the size of a scene: products of four lengths must stay in the range of floats.
constexpr float kSmallestScene = 1e-6f, kLargestScene = 1e9f;

// Maximum number of emissive triangles of one mesh over all its instances, each of which is stored.
constexpr size_t kMaxLamps = size_t{1} << 27;

// Maximum number of lookups of an expression. Shared operands can make it exponential in the number
// of expressions.
constexpr uint32_t kMaxLookups = 1000;

constexpr const char* kGrey = "it is grey";

bool isFinite(const FilePoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

std::string distanceText(double distance) {
  return distance < 1e30 ? shortestText(static_cast<float>(distance)) : shortestText(distance);
}

// A camera above and to the right that looks at the middle.
Camera cameraThatSees(const Bounds& bounds) {
  Camera c;
  c.verticalFovRad = 0.7f;
  c.forward = normalize(Vec3{-1.0f, -0.6f, -1.2f});
  c.right = normalize(cross(c.forward, {0, 1, 0}));
  c.up = cross(c.right, c.forward);
  const float distance = 0.5f * bounds.diagonal() / std::sin(0.5f * c.verticalFovRad);
  c.position = bounds.center() - distance * c.forward;
  return c;
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

SceneBuilder::SceneBuilder(fs::path sceneFile, OnWarning onWarning)
    : onWarning_(std::move(onWarning)) {
  scene_.files.push_back(std::move(sceneFile));
}

void SceneBuilder::setFilm(const Film& film) {
  scene_.film = film;
  for (View& view : scene_.views) view.film = film;
}

void SceneBuilder::setCamera(const FilePoint& position, const Camera& camera) {
  scene_.views.clear();
  viewPositions_.clear();
  addCamera("", position, camera, scene_.film);
}

void SceneBuilder::addCamera(const std::string& name, const FilePoint& position,
                             const Camera& camera, const Film& film) {
  scene_.views.push_back({name, camera, film});
  viewPositions_.push_back(position);
}

uint32_t SceneBuilder::addTexture(const TextureUse& use, const std::string& otherwise) {
  if (use.bytes) return textures_.add(use);
  addFile(use.file);
  if (!isRegularFile(use.file)) {
    warn(use.file.string() + ": no such texture; " + otherwise);
    return kNone;
  }
  return textures_.add(use);
}

uint32_t SceneBuilder::addReplacement(Material material) {
  assert(!material.name.empty() && !replacements_.contains(material.name));
  const std::string name = material.name;
  return replacements_[name] = addMaterial(std::move(material));
}

uint32_t SceneBuilder::addGreyableImage(const TextureUse& use, TextureExpression image) {
  image.image = addTexture(use, kGrey);
  if (image.image == kNone) return addExpression(constantExpression(Vec3{0.5f}));
  const uint32_t expression = addExpression(image);
  greyable_.push_back(expression);
  return expression;
}

uint32_t SceneBuilder::addMaterial(Material material) {
  if (const auto it = replacements_.find(material.name); it != replacements_.end()) {
    replaced_.insert(material.name);
    return it->second;
  }
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

std::optional<Vec3> SceneBuilder::constantValue(uint32_t expression) const {
  if (expression == kNone) return Vec3(1);
  const TextureExpression& e = scene_.expressions[expression];
  if (e.kind == TextureExpression::Kind::Checkerboard) return {};
  if (e.kind == TextureExpression::Kind::Image && e.image != kNone) return {};
  for (const uint32_t operand : {e.first, e.second, e.amount}) {
    if (operand != kNone && !constantValue(operand)) return {};
  }
  return TextureEvaluator(scene_.expressions, {}).at(expression, 0.0f, 0.0f);
}

uint32_t SceneBuilder::greyMaterial() {
  if (grey_ == kNone) {
    Material grey;
    grey.phong().diffuse = Vec3{0.5f};
    grey_ = addMaterial(std::move(grey));
  }
  return grey_;
}

EnvironmentImage SceneBuilder::readEnvironment(const fs::path& image) {
  const ReadGuard guard(image);
  size_t negative = 0;
  EnvironmentImage radiance = loadEnvironment(image, negative);
  guard.check();
  warnOfNegative(image.string(), negative, radiance.radiance.size());
  return radiance;
}

void SceneBuilder::warnOfNegative(const std::string& image, size_t negative, size_t pixels) {
  if (negative == 0) return;
  warn(image + ": " + std::to_string(negative) + " of " + std::to_string(pixels) +
       " pixels have negative values, which count as 0");
}

uint32_t SceneBuilder::addEnvironment(const fs::path& image, EnvironmentImage radiance) {
  scene_.environments.push_back(std::move(radiance));
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
  if (open_ != kNone) {
    const auto all = [](std::span<const double> s) { return std::vector(s.begin(), s.end()); };
    const auto grey = std::ranges::count(mesh.triangles, kNone, &Triangle::material);
    prototypes_[open_].push_back({file, all(mesh.positions), all(mesh.normals), all(mesh.uvs),
                                  std::move(mesh.triangles), transform});
    return static_cast<size_t>(grey);
  }
  recordMesh(file.string(), mesh.triangles.size());
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
  parts_.push_back({file, scene_.triangles.size(), points_.size(), shared_});
  return grey;
}

// Stores a mesh in its prototype. Emissive triangles go to the world instead, once for each
// instance.
void SceneBuilder::shareMesh(const KeptMesh& kept, uint32_t prototype) {
  std::vector<Triangle> rest, lamps;
  for (const Triangle& t : kept.triangles) {
    const bool lamp = t.material != kNone && !isBlack(scene_.materials[t.material].emission);
    (lamp ? lamps : rest).push_back(t);
  }
  const auto uses = static_cast<size_t>(std::ranges::count(placed_, prototype, &Placed::prototype));
  if (lamps.size() * uses > kMaxLamps) {
    throw InputError(kept.file, "is placed so often that its lamps are more than " +
                                    std::to_string(kMaxLamps) + " triangles; place it less often");
  }
  for (const Placed& p : placed_) {
    if (p.prototype == prototype && !lamps.empty())
      addMesh(kept.file, kept.mesh(lamps), p.toWorld * kept.transform);
  }
  if (rest.empty()) return;
  shared_ = prototype;
  addMesh(kept.file, kept.mesh(std::move(rest)), kept.transform);
  shared_ = kNone;
  scene_.meshes[meshOfName_.at(kept.file.string())].instances += uses - 1;
}

void SceneBuilder::placePrototypes() {
  open_ = kNone;
  for (uint32_t p = 0; p < prototypes_.size(); ++p) {
    const auto uses = std::ranges::count(placed_, p, &Placed::prototype);
    for (const KeptMesh& kept : prototypes_[p]) {
      if (uses > 1) shareMesh(kept, p);
      if (uses != 1) continue;
      const auto placed = std::ranges::find(placed_, p, &Placed::prototype);
      addMesh(kept.file, kept.mesh(kept.triangles), placed->toWorld * kept.transform);
    }
    if (uses == 1) std::erase_if(placed_, [&](const Placed& o) { return o.prototype == p; });
    prototypes_[p] = {};
  }
}

// Replaces the pool's numbers in all maps by indices into Scene::textures.
void SceneBuilder::resolveTextures() {
  TexturePool::Result read = textures_.take();
  std::vector<bool> grey(read.indexOf.size(), false);
  for (const uint32_t e : greyable_) grey[scene_.expressions[e].image] = true;
  size_t next = 0;
  for (size_t i = 0; i < read.indexOf.size(); ++i) {
    if (read.indexOf[i] == TexturePool::kUnreadable)
      warn(read.problems.at(next++) + "; " + (grey[i] ? kGrey : kPlainColour));
  }
  scene_.textures = std::move(read.textures);
  for (const Texture& t : scene_.textures) warnOfNegative(t.name, t.negative, t.floats.size() / 4);
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
  for (const uint32_t e : greyable_) {
    if (scene_.expressions[e].image == kNone)
      scene_.expressions[e] = constantExpression(Vec3{0.5f});
  }
}

// Folds constant textures into the parameters, so that they also apply to faces without texture
// coordinates.
void SceneBuilder::foldConstants() {
  std::vector<std::optional<Vec3>> constants;
  for (uint32_t e = 0; e < scene_.expressions.size(); ++e) constants.push_back(constantValue(e));
  const auto take = [&](uint32_t& texture, const auto& fold) {
    if (texture == kNone || !constants[texture]) return;
    fold(*constants[texture]);
    texture = kNone;
  };
  const auto field = [&]<typename Field>(const char*, Field& f) {
    if constexpr (Like<Field, Colour>)
      take(f.texture, [&](Vec3 v) { f.value = f.value * v; });
    else if constexpr (Like<Field, Scalar>)
      take(f.texture, [&](Vec3 v) { f.value *= v.x; });
  };
  for (Material& m : scene_.materials) {
    std::visit([&](auto& model) { forEachField(model, field); }, m.model);
    take(m.emissionTexture, [&](Vec3 v) { m.emission = m.emission * v; });
    take(m.opacityTexture, [&](Vec3 v) { m.opacity *= v.x; });
    for (Relief* relief : {&m.relief, &m.coatRelief}) take(relief->bumpMap, [](Vec3) {});
  }
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

// Scenes with instances are not searched: their world triangles do not represent their extent.
void SceneBuilder::findStrays() {
  if (!placed_.empty()) return;
  const auto corners = [&](size_t i) { return cornersOf(scene_.triangles[i]); };
  strays_ = Strays(scene_.triangles.size(), corners);
  if (strays_.count() > 0) {
    warn(name() + ": " + std::to_string(strays_.count()) +
         (strays_.count() == 1 ? " triangle lies " : " triangles lie up to ") +
         distanceText(strays_.furthest()) +
         " away from the middle of the others; if it is there by mistake, remove it");
  }
  cutFarFaces();
}

// Cuts faces that reach from the scene to far away into pieces that are small relative to their
// distance. Floats then resolve hits on the near pieces, and the far ones count as strays.
void SceneBuilder::cutFarFaces() {
  std::vector<Triangle> pieces;
  size_t kept = 0, begin = 0, faces = 0;
  double furthest = 0.0;
  fs::path file;
  for (Part& part : parts_) {
    for (size_t t = begin; t < part.endTriangle; ++t) {
      const Triangle face = scene_.triangles[t];
      const Corners corners = cornersOf(face);
      if (!strays_.reaches(corners)) {
        scene_.triangles[kept++] = face;
        continue;
      }
      if (faces++ == 0) file = part.file;
      furthest = std::max(furthest, strays_.distance(corners));
      cut(face, pieces);
    }
    begin = part.endTriangle;
    part.endTriangle = kept;
  }
  if (faces == 0) return;
  scene_.triangles.resize(kept);
  scene_.triangles.insert(scene_.triangles.end(), pieces.begin(), pieces.end());
  parts_.push_back({file, scene_.triangles.size(), points_.size(), kNone, /*pieces=*/true});
  strays_.cutAt(scene_.triangles.size(), [&](size_t i) { return cornersOf(scene_.triangles[i]); });
  warn(file.string() + ": " + std::to_string(faces) +
       (faces == 1 ? " triangle reaches " : " triangles reach up to ") + distanceText(furthest) +
       " away from the middle of the others; if a vertex is there by mistake, mend it");
}

// Bisects longest edges until all pieces may stay.
void SceneBuilder::cut(const Triangle& face, std::vector<Triangle>& pieces) {
  const auto squaredEdge = [&](const Corners& c, size_t k) {
    double sum = 0.0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double d = c[k][axis] - c[(k + 1) % 3][axis];
      sum += d * d;
    }
    return sum;
  };
  std::vector<Triangle> left{face};
  while (!left.empty()) {
    const Triangle t = left.back();
    left.pop_back();
    const Corners corners = cornersOf(t);
    if (strays_.mayStay(corners)) {
      pieces.push_back(t);
      continue;
    }
    size_t longest = 0;
    for (size_t k = 1; k < 3; ++k) {
      if (squaredEdge(corners, k) > squaredEdge(corners, longest)) longest = k;
    }
    const size_t a = longest, b = (longest + 1) % 3;
    Triangle first = t, second = t;
    first.position[b] = second.position[a] = static_cast<uint32_t>(points_.size());
    FilePoint middle{};
    for (size_t axis = 0; axis < 3; ++axis)
      middle[axis] = 0.5 * corners[a][axis] + 0.5 * corners[b][axis];
    points_.push_back(middle);
    if (t.normal[a] != kNone && t.normal[b] != kNone) {
      first.normal[b] = second.normal[a] = static_cast<uint32_t>(scene_.normals.size());
      const Vec3 sum = scene_.normals[t.normal[a]] + scene_.normals[t.normal[b]];
      scene_.normals.push_back(isBlack(sum) ? scene_.normals[t.normal[a]] : normalize(sum));
    } else {
      first.normal[b] = second.normal[a] = kNone;
    }
    if (t.uv[a] != kNone && t.uv[b] != kNone) {
      const auto u = scene_.uvs[t.uv[a]], v = scene_.uvs[t.uv[b]];
      first.uv[b] = second.uv[a] = static_cast<uint32_t>(scene_.uvs.size());
      scene_.uvs.push_back({0.5f * u[0] + 0.5f * v[0], 0.5f * u[1] + 0.5f * v[1]});
    } else {
      first.uv[b] = second.uv[a] = kNone;
    }
    left.push_back(second);
    left.push_back(first);
  }
}

// Rounds points to floats, relative to the scene's origin. Prototypes keep their own coordinates.
void SceneBuilder::roundPositions() {
  FilePoint lower, upper;
  lower.fill(INFINITY);
  upper.fill(-INFINITY);
  const auto extend = [&](const FilePoint& p) {
    for (size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], p[i]);
      upper[i] = std::max(upper[i], p[i]);
    }
  };
  size_t triangle = 0;
  for (const Part& part : parts_) {
    for (; triangle < part.endTriangle; ++triangle) {
      const Corners corners = cornersOf(scene_.triangles[triangle]);
      if (part.prototype == kNone && !strays_.has(corners)) std::ranges::for_each(corners, extend);
    }
  }
  for (const Placed& p : placed_) extend(p.toWorld.point({}));
  if (!scene_.triangles.empty()) scene_.origin = sceneOrigin(lower, upper);
  scene_.positions.reserve(points_.size() + 1);
  for (const Part& part : parts_) {
    const FilePoint origin = part.prototype == kNone ? scene_.origin : FilePoint{};
    while (scene_.positions.size() < part.endPoint)
      scene_.positions.push_back(fromOrigin(points_[scene_.positions.size()], origin));
  }
  points_ = {};
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    LightSpec& light = scene_.lights[i];
    if (light.type == LightType::Point || light.type == LightType::Spot) {
      requirePlace(lightPositions_[i], "a light");
      light.position = fromOrigin(lightPositions_[i], scene_.origin);
    }
  }
  if (scene_.origin != FilePoint{}) {
    std::ostringstream text;
    text.precision(15);
    text << scene_.name() << ": lies far from its origin; coordinates count from ("
         << scene_.origin[0] << ", " << scene_.origin[1] << ", " << scene_.origin[2] << ")";
    warn(text.str());
  }
}

// Drops triangles whose normal cannot be computed in floats, as it is at every hit.
void SceneBuilder::dropUnusable() {
  size_t kept = 0, next = 0;
  for (Part& part : parts_) {
    size_t flat = 0, extreme = 0;
    for (; next < part.endTriangle; ++next) {
      const Triangle& t = scene_.triangles[next];
      const Vec3 p0 = scene_.positions[t.position[0]], p1 = scene_.positions[t.position[1]],
                 p2 = scene_.positions[t.position[2]];
      const Vec3 normal = cross(p1 - p0, p2 - p0);
      const float length2 = lengthSquared(normal);
      if (std::isnormal(length2)) {
        scene_.triangles[kept++] = t;
      } else if (!part.pieces) {
        ++(isBlack(normal) ? flat : extreme);
      }
    }
    part.endTriangle = kept;
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

// Keeps one of several coincident emissive triangles of equal winding: light sampling would count
// all of them, while a ray hits only one.
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
  const uint32_t worldEnd = scene_.worldEnd();
  const auto begin = scene_.triangles.begin();
  const auto end = std::remove_if(begin, begin + worldEnd, doubled);  // prototypes hold no lamps
  const auto dropped = static_cast<uint32_t>(begin + worldEnd - end);
  scene_.triangles.erase(end, begin + worldEnd);
  for (Prototype& p : scene_.prototypes) p.begin -= dropped, p.end -= dropped;
  if (dropped > 0) {
    warn(scene_.name() + ": " + std::to_string(dropped) +
         " emissive triangles lie on others; one of each is left, or it would shine twice");
  }
}

// Moves opaque triangles to the front of the world and of each prototype.
void SceneBuilder::sortByMask() {
  const auto opaque = [&](const Triangle& t) { return !scene_.materials[t.material].masked(); };
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
    if (!(scale > 0.0) || !std::isfinite(scale)) {
      warn(scene_.name() + ": an instance without volume, or beyond what floats hold, is left out");
      continue;
    }
    scene_.instances.push_back(instance);
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
  for (const Instance& i : scene_.instances) {
    const Bounds& box = boxes[i.prototype];
    for (int corner = 0; corner < 8; ++corner) {
      scene_.bounds.extend(
          i.point({corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                   corner & 4 ? box.upper.z : box.lower.z}));
    }
  }
}

void SceneBuilder::requirePlace(const FilePoint& p, const char* what) const {
  for (const double x : p) {
    if (std::fabs(x) <= kFurthestPlace) continue;
    throw InputError(name() + ": " + what + " lies at " + shortestText(x) + ", beyond " +
                     shortestText(kFurthestPlace) + "; move it towards the scene");
  }
}

void SceneBuilder::placeViews() {
  for (const FilePoint& p : viewPositions_) requirePlace(p, "a camera");
  for (size_t i = 0; i < scene_.views.size(); ++i)
    scene_.views[i].camera.position = fromOrigin(viewPositions_[i], scene_.origin);
  if (scene_.views.empty()) {
    scene_.views.push_back({"", cameraThatSees(scene_.bounds), scene_.film});
    warn(scene_.name() + ": has no camera; one is placed that sees the whole scene");
  }
  scene_.camera = scene_.views.front().camera;
  scene_.film = scene_.views.front().film;
}

void SceneBuilder::requireSize() const {
  if (scene_.triangles.empty())
    throw InputError(scene_.name() + ": has no triangle; give it a mesh that has an area");
  if (strays_.furthest() > double{kLargestScene}) {
    throw InputError(scene_.name() + ": has a triangle that lies " +
                     distanceText(strays_.furthest()) + " away from the others, beyond " +
                     shortestText(kLargestScene) + "; remove it");
  }
  const float size = scene_.bounds.diagonal();
  if (size > kLargestScene && scene_.nearSize <= kLargestScene) {
    throw InputError(scene_.name() + ": has a triangle that reaches " + shortestText(size) +
                     " away from the others, beyond " + shortestText(kLargestScene) +
                     "; mend or remove it");
  }
  if (size >= kSmallestScene && size <= kLargestScene) return;
  throw InputError(scene_.name() + ": is " + shortestText(size) + " units across, outside " +
                   shortestText(kSmallestScene) + " to " + shortestText(kLargestScene) +
                   ", where floats suffice; change the meshes' 'scale' and the lights");
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
  extendBounds();
  for (const std::string& warning : liftCoplanarLamps(scene_)) warn(warning);
  scene_.positions.push_back({});  // Embree reads 16 bytes at each vertex
  requireSize();
  placeViews();
  if (!scene_.hasLight()) warn(scene_.name() + ": " + kNoLight);
  scene_.contentHash = hashScene(scene_);
  return std::exchange(scene_, {});
}

}  // namespace bnvpl
