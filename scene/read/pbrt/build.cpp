#include "scene/read/pbrt/build.h"

#include <cmath>
#include <exception>
#include <set>

#include "core/parallel.h"
#include "scene/read/pbrt/lights.h"
#include "scene/read/pbrt/materials.h"
#include "scene/read/pbrt/shapes/shapes.h"
#include "scene/read/pbrt/syntax/transform.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kAtOnce = 256;  // shapes that are in memory beside the scene

// A shape and its transforms: one in the world, or one for each instance of its object.
struct Placed {
  const Shape* shape;
  std::vector<Affine> worldFromShape;
  std::string object = {};  // the name of its object; empty in the world
};

std::vector<Placed> placedShapes(const Description& d) {
  std::vector<Placed> out;
  for (const Shape& shape : d.shapes) out.push_back({&shape, {shape.worldFromObject}});
  std::map<std::string, std::vector<Affine>> places;
  for (const Instance& instance : d.instances) {
    if (!d.objects.contains(instance.object))
      failAt(instance.place, "there is no object '" + instance.object + "'");
    places[instance.object].push_back(instance.worldFromInstance);
  }
  for (const auto& [name, transforms] : places) {
    for (const Shape& shape : d.objects.at(name).shapes) {
      Placed placed{&shape, {}, name};
      for (const Affine& t : transforms) placed.worldFromShape.push_back(t * shape.worldFromObject);
      out.push_back(std::move(placed));
    }
  }
  return out;
}

double areaOf(const MeshData& mesh, const Affine& transform) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    FilePoint p[3];
    for (size_t k = 0; k < 3; ++k) {
      const double* at = &mesh.positions[3 * t.position[k]];
      p[k] = transform.point({at[0], at[1], at[2]});
    }
    FilePoint n;
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = (p[1][j] - p[0][j]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][j] - p[0][j]);
    }
    sum += 0.5 * std::hypot(n[0], n[1], n[2]);
  }
  return sum;
}

class Meshes {
 public:
  Meshes(const LightReader& reader, Materials& materials, SceneBuilder& builder)
      : reader_(reader), materials_(materials), builder_(builder) {}

  // Tessellates the shapes in parallel, then adds them to the scene in order.
  void add(std::span<const Placed> shapes) {
    std::vector<MeshData> meshes(shapes.size());
    std::vector<std::exception_ptr> failures(shapes.size());
    parallelFor(shapes.size(), 1, [&](size_t i) {
      try {
        meshes[i] = tessellate(*shapes[i].shape, reader_.folder);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
    for (size_t i = 0; i < shapes.size(); ++i) {
      if (failures[i]) std::rethrow_exception(failures[i]);
      place(shapes[i], std::move(meshes[i]));
    }
  }

 private:
  // Stores a shape of many instances once. None of those emits: pbrt has no lamps in objects.
  void place(const Placed& placed, MeshData mesh) {
    const Shape& shape = *placed.shape;
    for (const std::string& note : mesh.notes) reader_.notes.add(shape.place, note);
    fs::path file = meshFileOf(shape, reader_.folder);
    if (file.empty()) {
      file = *shape.place.file;
    } else {
      builder_.addFile(file);
    }
    if (placed.worldFromShape.size() > 1) return share(placed, std::move(mesh), file);
    const Affine& transform = placed.worldFromShape.front();
    const uint32_t material = materials_.of(shape, emission(shape, mesh, transform));
    if (material == kNone) return;  // an interface has no surface
    for (Triangle& t : mesh.triangles) t.material = material;
    const uint32_t object = objectOf(placed);
    builder_.addMesh(file, {mesh.positions, mesh.normals, mesh.uvs, mesh.triangles, {{0, object}}},
                     transform);
  }

  void share(const Placed& placed, MeshData mesh, const fs::path& file) {
    const uint32_t material = materials_.of(*placed.shape, {});
    if (material == kNone) return;  // an interface has no surface
    for (Triangle& t : mesh.triangles) t.material = material;
    const uint32_t prototype = builder_.beginPrototype();
    builder_.addMesh(file, {mesh.positions, mesh.normals, mesh.uvs, mesh.triangles});
    builder_.endPrototype();
    const uint32_t object = objectOf(placed);
    for (const Affine& transform : placed.worldFromShape)
      builder_.addInstance(prototype, transform, object);
  }

  uint32_t objectOf(const Placed& placed) {
    const std::string own = nameOf(*placed.shape, reader_.folder);
    return builder_.addObject(placed.object.empty() ? own : placed.object);
  }

  ShapeEmission emission(const Shape& shape, const MeshData& mesh, const Affine& transform) const {
    if (shape.areaLight == kNone) return {};
    const Entity& light = reader_.description.areaLights[shape.areaLight];
    const bool wantsArea = light.params.has("power");
    return emissionOf(reader_, light, wantsArea ? areaOf(mesh, transform) : 1.0,
                      mesh.pieces > 0 ? mesh.pieces : mesh.triangles.size());
  }

  const LightReader& reader_;
  Materials& materials_;
  SceneBuilder& builder_;
};

// Notes the parameters that no reader used.
void noteUnused(const char* directive, const Entity& entity, Notes& notes) {
  for (const Param* p : entity.params.unused()) {
    notes.add(p->place, std::string(directive) + " \"" + entity.type + "\": parameter '" + p->name +
                            "' is unknown and ignored");
  }
}

void noteUnused(const Description& d, const std::vector<Placed>& shapes, Notes& notes) {
  noteUnused("Film", d.film, notes);
  noteUnused("Camera", d.camera, notes);
  noteUnused("PixelFilter", d.pixelFilter, notes);
  for (const Light& light : d.lights) noteUnused("LightSource", light, notes);
  std::set<uint32_t> lamps;
  for (const Placed& placed : shapes) {
    noteUnused("Shape", *placed.shape, notes);
    const uint32_t lamp = placed.shape->areaLight;
    if (lamp != kNone && d.areaLights[lamp].type == "diffuse" && lamps.insert(lamp).second)
      noteUnused("AreaLightSource", d.areaLights[lamp], notes);
  }
}

}  // namespace

void build(const Description& description, const fs::path& folder, Notes& notes,
           SceneBuilder& builder) {
  std::vector<fs::path> spectra;
  const Colors colors(folder, notes, spectra);
  const Sensor sensor = sensorOf(description, notes);
  const LightReader reader{description, folder, colors, sensor, notes};
  buildCamera(description, notes, builder);
  Materials materials(reader, builder);
  const std::vector<Placed> shapes = placedShapes(description);
  for (const Placed& placed : shapes) materials.expect(*placed.shape);
  buildLights(reader, builder);
  Meshes meshes(reader, materials, builder);
  for (size_t at = 0; at < shapes.size(); at += kAtOnce)
    meshes.add(std::span(shapes).subspan(at, std::min(kAtOnce, shapes.size() - at)));
  for (const fs::path& file : spectra) builder.addFile(file);
  noteUnused(description, shapes, notes);
  materials.noteUnused();
}

}  // namespace bnvpl::pbrt
