#include "scene/read/obj/load_obj.h"

#include <algorithm>
#include <fstream>

#include "core/files.h"
#include "scene/read/obj/load_materials.h"
#include "scene/read/obj/read_obj.h"

namespace bnvpl {

namespace {

// Numbers in the scene of the reading's materials. Only what a face uses is added: a library may
// name textures that nobody needs.
std::vector<uint32_t> addMaterials(const fs::path& obj, const ObjReading& reading,
                                   SceneBuilder& builder) {
  const MaterialLibraries& libraries = reading.libraries;
  std::vector<bool> used(libraries.materials.size(), false);
  for (const tinyobj::shape_t& shape : reading.shapes) {
    for (const int id : shape.mesh.material_ids) {
      if (id >= 0 && static_cast<size_t>(id) < used.size()) used[static_cast<size_t>(id)] = true;
    }
  }
  std::vector<uint32_t> numbers(used.size(), kNone);
  for (size_t i = 0; i < used.size(); ++i) {
    if (used[i])
      numbers[i] = addMaterial({libraries.libraryOf[i], obj, libraries.keysOf[i]},
                               libraries.materials[i], builder);
  }
  return numbers;
}

// Takes the shapes one by one, so that both forms of a mesh need not fit into memory.
std::vector<Triangle> takeTriangles(std::vector<tinyobj::shape_t>& shapes,
                                    const std::vector<uint32_t>& materials) {
  const auto at = [](int index) { return index >= 0 ? static_cast<uint32_t>(index) : kNone; };
  std::vector<Triangle> triangles;
  for (tinyobj::shape_t& shape : shapes) {
    const tinyobj::mesh_t& mesh = shape.mesh;
    const size_t count = std::min(mesh.num_face_vertices.size(), mesh.indices.size() / 3);
    for (size_t f = 0; f < count; ++f) {
      Triangle t;
      for (size_t k = 0; k < 3; ++k) {
        const tinyobj::index_t& i = mesh.indices[3 * f + k];
        t.position[k] = at(i.vertex_index);
        t.normal[k] = at(i.normal_index);
        t.uv[k] = at(i.texcoord_index);
      }
      const uint32_t material = at(mesh.material_ids[f]);
      t.material = material < materials.size() ? materials[material] : kNone;
      triangles.push_back(t);
    }
    shape = {};
  }
  return triangles;
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

}  // namespace

void loadObj(const fs::path& obj, const fs::path& materials, const Affine& transform,
             SceneBuilder& builder) {
  if (!isRegularFile(obj) || !std::ifstream(obj)) {
    throw InputError(obj, "no such OBJ file; check 'file' in the scene.toml");
  }
  if (!materials.empty() && !isRegularFile(materials)) {
    throw InputError(materials, "no such MTL file; check 'materials' in the scene.toml");
  }
  builder.addFile(obj);
  ObjReading reading = readObj(
      obj, materials,
      [&](const fs::path& library, const tinyobj::material_t& material, const MtlKeys& keys) {
        expectTextures({library, obj, keys}, material, builder);
      });
  for (const fs::path& library : reading.libraries.missing) {
    builder.addFile(library);
    builder.warn(library.string() + ": no such material library; its materials are grey");
  }
  for (const fs::path& library : reading.libraries.read) builder.addFile(library);
  const std::vector<uint32_t> numbers = addMaterials(obj, reading, builder);

  Mesh mesh{reading.attrib.vertices, reading.attrib.normals, reading.attrib.texcoords, {}};
  mesh.triangles = takeTriangles(reading.shapes, numbers);
  // The builder leaves them out and counts them, as triangles that lack a vertex.
  mesh.triangles.resize(mesh.triangles.size() + reading.lostTriangles,
                        {kNoCorners, kNoCorners, kNoCorners, kNone});
  if (reading.uncutTriangles > 0) {
    builder.warn(obj.string() + ": " + std::to_string(reading.uncutTriangles) +
                 " triangles of polygons that cannot be cut are left out; triangulate the mesh");
  }
  if (builder.addMesh(obj, std::move(mesh), transform) > 0) warnOfGrey(obj, reading, builder);
}

}  // namespace bnvpl
