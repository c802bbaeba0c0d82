#include "scene/read/obj/load_obj.h"

#include <algorithm>
#include <fstream>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/obj/mtl/load_materials.h"
#include "scene/read/obj/read_obj.h"
#include "scene/triangulate.h"

namespace bnvpl {

namespace {

// Numbers in the scene of the reading's materials. Only what a face uses is added: a library may
// name textures that nobody needs.
std::vector<uint32_t> addMaterials(const fs::path& obj, const ObjReading& reading,
                                   SceneBuilder& builder) {
  const MaterialLibraries& libraries = reading.libraries;
  std::vector<bool> used(libraries.materials.size(), false);
  for (const int id : reading.mesh.materials) {
    if (id >= 0) used.at(static_cast<size_t>(id)) = true;
  }
  std::vector<uint32_t> numbers(used.size(), kNone);
  for (size_t i = 0; i < used.size(); ++i) {
    if (used[i])
      numbers[i] = addMaterial({libraries.libraryOf[i], obj, libraries.keysOf[i]},
                               libraries.materials[i], builder);
  }
  return numbers;
}

struct CutFaces {
  std::vector<Triangle> triangles;
  std::vector<ObjectRun> objects;
  size_t crossing = 0;  // polygons that cross themselves
};

// Follows the names of an OBJ from face to face.
class Objects {
 public:
  Objects(const fs::path& obj, const std::vector<MeshLines::Object>& names, SceneBuilder& builder)
      : obj_(obj), builder_(builder), next_(names.begin()), end_(names.end()) {}

  // Adds a run if the triangles from `triangle` on, of the next face, are of another object.
  void before(size_t face, size_t triangle, std::vector<ObjectRun>& runs) {
    const std::string* name = nullptr;
    for (; next_ != end_ && next_->face <= face; ++next_) name = &next_->name;
    if (!name && !runs.empty()) return;
    const uint32_t object =
        name && !name->empty() ? builder_.addObject(*name) : builder_.addObjectOf(obj_);
    if (runs.empty() || runs.back().object != object)
      runs.push_back({static_cast<uint32_t>(triangle), object});
  }

 private:
  const fs::path& obj_;
  SceneBuilder& builder_;
  std::vector<MeshLines::Object>::const_iterator next_, end_;
};

// A polygon that lacks a vertex is lost as a whole: its triangles have no corners, and the builder
// leaves them out and counts them.
CutFaces cutFaces(const ObjMesh& mesh, const std::vector<uint32_t>& materials, Objects objects) {
  CutFaces out;
  out.triangles.reserve(mesh.counts.size());
  std::vector<FilePoint> outline;
  std::vector<std::array<uint32_t, 3>> cut;
  const ObjCorner* corner = mesh.corners.data();
  for (size_t f = 0; f < mesh.counts.size(); corner += mesh.counts[f++]) {
    objects.before(f, out.triangles.size(), out.objects);
    const std::span<const ObjCorner> face(corner, mesh.counts[f]);
    const uint32_t material =
        mesh.materials[f] < 0 ? kNone : materials[static_cast<size_t>(mesh.materials[f])];
    outline.clear();
    cut.clear();
    for (const ObjCorner& c : face) {
      if (c.vertex >= mesh.positions.size() / 3) break;
      const double* p = &mesh.positions[3 * size_t{c.vertex}];
      outline.push_back({p[0], p[1], p[2]});
    }
    if (outline.size() < face.size()) {
      out.triangles.resize(out.triangles.size() + face.size() - 2,
                           {kNoCorners, kNoCorners, kNoCorners, material});
      continue;
    }
    out.crossing += !triangulate(outline, QuadCut::ShorterDiagonal, cut);
    for (const auto& [a, b, c] : cut) {
      out.triangles.push_back({{face[a].vertex, face[b].vertex, face[c].vertex},
                               {face[a].normal, face[b].normal, face[c].normal},
                               {face[a].uv, face[b].uv, face[c].uv},
                               material});
    }
  }
  return out;
}

// 'a', 'b' and 3 more: of many, the first ones.
template <typename Items, typename ToText>
std::string listOf(const Items& items, const ToText& toText) {
  constexpr size_t kNamed = 6;
  std::string list;
  size_t count = 0;
  for (const auto& item : items) {
    if (++count <= kNamed) list += (list.empty() ? "" : ", ") + toText(item);
  }
  return count <= kNamed ? list : list + " and " + std::to_string(count - kNamed) + " more";
}

void warnOfGrey(const fs::path& obj, const ObjReading& reading, SceneBuilder& builder) {
  if (reading.unknown.empty()) {
    builder.warn(
        obj.string() +
        ": has faces without a material; they are grey (Kd 0.5): no usemtl stands before them");
    return;
  }
  const std::string names =
      listOf(reading.unknown, [](const std::string& name) { return "'" + name + "'"; });
  const std::string libraries =
      listOf(reading.libraries.read, [](const fs::path& file) { return file.string(); });
  builder.warn(
      obj.string() + ": has faces without a known material; they are grey (Kd 0.5): " + names +
      (reading.unknown.size() == 1 ? " is" : " are") +
      (libraries.empty() ? " asked for, but no material library was read; name one by mtllib"
                         : " not in " + libraries));
}

void warnOfStrangeKeys(const MaterialLibraries& libraries, SceneBuilder& builder) {
  for (const auto& [library, notes] : libraries.notes) {
    const std::vector<std::string>& keys = notes.strangeKeys;
    if (keys.empty()) continue;
    const bool one = keys.size() == 1;
    builder.warn(library.string() + ": " +
                 (one ? "a key has no meaning and is ignored: "
                      : std::to_string(keys.size()) + " keys have no meaning and are ignored: ") +
                 listOf(keys, [](const std::string& key) { return key; }) +
                 (one ? "; correct it if it is misspelt" : "; correct those that are misspelt"));
  }
}

// Reads the OBJ. What the lines before an error ignore is told before it, of any material.
ObjReading readOrWarn(const fs::path& obj, const fs::path& materials, SceneBuilder& builder) {
  const auto expect = [&](const fs::path& library, const tinyobj::material_t& material,
                          const MtlKeys& keys) {
    expectTextures({library, obj, keys}, material, builder);
  };
  ObjReading reading;
  try {
    readObj(obj, materials, expect, reading);
  } catch (const InputError&) {
    for (const auto& [library, notes] : reading.libraries.notes) {
      for (const auto& [material, lines] : notes.byMaterial) {
        for (const std::string& line : lines) builder.warn(line);
      }
    }
    warnOfStrangeKeys(reading.libraries, builder);
    throw;
  }
  return reading;
}

}  // namespace

void loadObj(const fs::path& obj, const fs::path& materials, const Affine& transform,
             SceneBuilder& builder) {
  if (!isRegularFile(obj) || !std::ifstream(obj)) {
    throw InputError(obj, whyUnreadable(obj, "OBJ file") + "; check its name");
  }
  if (!materials.empty() && !isRegularFile(materials)) {
    throw InputError(
        materials, whyUnreadable(materials, "MTL file") + "; check 'materials' in the scene.toml");
  }
  builder.addFile(obj);
  ObjReading reading = readOrWarn(obj, materials, builder);
  for (const fs::path& library : reading.libraries.missing) {
    builder.addFile(library);
    builder.warn(library.string() + ": " + whyUnreadable(library, "material library") +
                 "; its materials are grey");
  }
  for (const fs::path& library : reading.libraries.read) builder.addFile(library);
  warnOfStrangeKeys(reading.libraries, builder);
  if (!reading.strangeKeywords.empty()) {
    builder.warn(
        obj.string() + ": lines are ignored, since their keywords have no meaning here: " +
        listOf(reading.strangeKeywords, [](const std::string& keyword) { return keyword; }) +
        "; correct those that are misspelt (keywords are in lower case)");
  }
  const std::vector<uint32_t> numbers = addMaterials(obj, reading, builder);

  CutFaces cut = cutFaces(reading.mesh, numbers, Objects(obj, reading.objects, builder));
  cut.triangles.resize(cut.triangles.size() + reading.lostTriangles,
                       {kNoCorners, kNoCorners, kNoCorners, kNone});
  if (cut.crossing > 0) builder.warn(obj.string() + ": " + crossingPolygons(cut.crossing));
  if (reading.unusableFaces > 0) {
    builder.warn(obj.string() + ": " + std::to_string(reading.unusableFaces) +
                 " faces of fewer than 3 corners are left out");
  }
  if (cut.triangles.empty()) builder.warn(obj.string() + ": has no faces; it adds nothing");
  Mesh mesh{reading.mesh.positions, reading.mesh.normals, reading.mesh.uvs,
            std::move(cut.triangles), std::move(cut.objects)};
  if (builder.addMesh(obj, std::move(mesh), transform) > 0) warnOfGrey(obj, reading, builder);
}

void readSceneObj(const fs::path& file, const Defines&, SceneBuilder& builder) {
  loadObj(file, {}, {}, builder);
}

}  // namespace bnvpl
