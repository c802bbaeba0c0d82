#include "scene/read/obj/load_obj.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/files.h"
#include "scene/read/obj/read_obj.h"

namespace bnvpl {

namespace {

FilePoint toPoint(const tinyobj::real_t* v) { return {v[0], v[1], v[2]}; }
bool isFinite(const FilePoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

}  // namespace

void ObjLoader::addTriangles(const fs::path& obj, const ObjReading& reading,
                             const std::vector<uint32_t>& materialOf, const Affine& transform) {
  const auto base = std::array{points_.size(), scene_.normals.size(), scene_.uvs.size()};
  const auto& a = reading.attrib;
  const size_t counts[3] = {a.vertices.size() / 3, a.normals.size() / 3, a.texcoords.size() / 2};
  for (size_t i = 0; i < counts[0]; ++i)
    points_.push_back(transform.point(toPoint(&a.vertices[3 * i])));
  for (size_t i = 0; i < counts[1]; ++i)
    scene_.normals.push_back(transform.normal(toPoint(&a.normals[3 * i])));
  for (size_t i = 0; i < counts[2]; ++i)
    scene_.uvs.push_back(
        {static_cast<float>(a.texcoords[2 * i]), static_cast<float>(a.texcoords[2 * i + 1])});

  const bool mirrored = transform.determinant() < 0.0;
  size_t damaged = 0;
  const auto resolve = [&](int index, size_t which) {
    const bool valid = index >= 0 && static_cast<size_t>(index) < counts[which];
    return valid ? static_cast<uint32_t>(base[which] + static_cast<size_t>(index)) : kNone;
  };
  uint32_t fallback = kNone;
  for (const tinyobj::shape_t& shape : reading.shapes) {
    const auto& mesh = shape.mesh;
    for (size_t f = 0; f + 1 <= mesh.num_face_vertices.size() && 3 * f + 2 < mesh.indices.size();
         ++f) {
      Triangle t;
      for (size_t k = 0; k < 3; ++k) {
        const tinyobj::index_t& i = mesh.indices[3 * f + (mirrored ? 2 - k : k)];
        t.position[k] = resolve(i.vertex_index, 0);
        t.normal[k] = resolve(i.normal_index, 1);
        t.uv[k] = resolve(i.texcoord_index, 2);
        if (t.normal[k] != kNone && isBlack(scene_.normals[t.normal[k]])) t.normal[k] = kNone;
      }
      const auto usable = [&](uint32_t p) { return p != kNone && isFinite(points_[p]); };
      if (!std::all_of(t.position.begin(), t.position.end(), usable)) {
        ++damaged;
        continue;
      }
      const int id = mesh.material_ids[f];
      if (id >= 0 && static_cast<size_t>(id) < materialOf.size()) {
        t.material = materialOf[static_cast<size_t>(id)];
      } else {
        if (fallback == kNone) fallback = materials_.fallback(obj);
        t.material = fallback;
      }
      const Material& m = scene_.materials[t.material];
      if (t.uv[0] == kNone &&
          (m.diffuseMap != kNone || m.glossyMap != kNone || m.opacityMap != kNone)) {
        warnings_.add(obj.string() + ": material '" + m.name +
                      "' has a texture but faces without texture coordinates; "
                      "the plain material colour is used there");
      }
      scene_.triangles.push_back(t);
    }
  }
  if (damaged > 0) {
    warnings_.add(obj.string() + ": " + std::to_string(damaged) +
                  " triangles with missing or non-finite vertices are left out");
  }
  parts_.push_back({obj, scene_.triangles.size()});
}

void ObjLoader::load(const fs::path& obj, const fs::path& materials, const Affine& transform) {
  if (!isRegularFile(obj) || !std::ifstream(obj)) {
    throw InputError(obj, "no such OBJ file; check 'file' in the scene.toml");
  }
  if (!materials.empty() && !isRegularFile(materials)) {
    throw InputError(materials, "no such MTL file; check 'materials' in the scene.toml");
  }
  scene_.files.push_back(obj);
  ObjReading reading =
      readObj(obj, materials, [&](const fs::path& library, const tinyobj::material_t& material) {
        materials_.expectTextures(library, obj, material);
      });
  for (const fs::path& library : reading.missing) {
    warnings_.add(library.string() + ": no such material library; its materials are grey");
  }
  scene_.files.insert(scene_.files.end(), reading.libraries.begin(), reading.libraries.end());
  // Only what a face uses is loaded: a library may name textures that nobody needs.
  std::vector<bool> used(reading.materials.size(), false);
  for (const auto& shape : reading.shapes) {
    for (const int id : shape.mesh.material_ids) {
      if (id >= 0 && static_cast<size_t>(id) < used.size()) used[static_cast<size_t>(id)] = true;
    }
  }
  const size_t firstMaterial = scene_.materials.size();
  std::vector<uint32_t> materialOf(used.size(), kNone);
  for (size_t i = 0; i < used.size(); ++i) {
    if (used[i]) materialOf[i] = materials_.add(reading.libraryOf[i], obj, reading.materials[i]);
  }
  materials_.loadTextures(firstMaterial);
  addTriangles(obj, reading, materialOf, transform);
}

void ObjLoader::roundPositions() {
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
  if (scene_.origin != FilePoint{}) {
    std::ostringstream text;
    text.precision(15);
    text << scene_.name() << ": lies far from its origin; coordinates count from ("
         << scene_.origin[0] << ", " << scene_.origin[1] << ", " << scene_.origin[2] << ")";
    warnings_.add(text.str());
  }
}

// A triangle is of use when its normal can be computed in floats, as every ray that hits it will.
void ObjLoader::dropUnusable() {
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
      warnings_.add(part.obj.string() + ": " + std::to_string(flat) +
                    " triangles without area are left out");
    }
    if (extreme > 0) {
      warnings_.add(
          part.obj.string() + ": " + std::to_string(extreme) +
          " triangles too small or too large for floats are left out; change their scale");
    }
  }
  scene_.triangles.resize(kept);
}

// Of emissive triangles that lie on each other, winding included, one stays: light sampling would
// count both, while a ray meets one.
void ObjLoader::dropDoubledLamps() {
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
    warnings_.add(
        scene_.name() + ": " + std::to_string(dropped) +
        " emissive triangles lie on others; one of each is left, or it would shine twice");
  }
}

void ObjLoader::finish() {
  roundPositions();
  dropUnusable();
  dropDoubledLamps();
  std::stable_partition(scene_.triangles.begin(), scene_.triangles.end(),
                        [&](const Triangle& t) { return !scene_.materials[t.material].masked(); });
  const auto firstMasked =
      std::find_if(scene_.triangles.begin(), scene_.triangles.end(),
                   [&](const Triangle& t) { return scene_.materials[t.material].masked(); });
  scene_.maskedBegin = static_cast<uint32_t>(firstMasked - scene_.triangles.begin());
  for (const Triangle& t : scene_.triangles) {
    for (const uint32_t p : t.position) scene_.bounds.extend(scene_.positions[p]);
  }
  scene_.positions.push_back({});  // Embree reads 16 bytes at each vertex
}

}  // namespace bnvpl
