#include "scene/read/pbrt/shapes/shapes.h"

#include <algorithm>
#include <numbers>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/pbrt/shapes/ply.h"
#include "scene/read/pbrt/syntax/text_file.h"
#include "scene/shapes/quadrics.h"

namespace bnvpl::pbrt {

namespace {

double phiMax(const Params& params) {
  return std::clamp(params.number("phimax", 360.0), 0.0, 360.0) * std::numbers::pi / 180.0;
}

}  // namespace

MeshData sphere(const Params& params) {
  const double r = params.number("radius", 1.0, 0.0);
  const double z0 = params.number("zmin", -r), z1 = params.number("zmax", r);
  return sphereMesh(r, z0, z1, phiMax(params));
}

MeshData disk(const Params& params) {
  const double r = params.number("radius", 1.0, 0.0),
               inner = params.number("innerradius", 0.0, 0.0);
  return diskMesh(r, inner, params.number("height", 0.0), phiMax(params));
}

MeshData cylinder(const Params& params) {
  const double r = params.number("radius", 1.0, 0.0);
  const double z0 = params.number("zmin", -1.0), z1 = params.number("zmax", 1.0);
  return cylinderMesh(r, z0, z1, phiMax(params));
}

fs::path meshFileOf(const Shape& shape, const fs::path& folder) {
  if (shape.type != "plymesh") return {};
  const std::string name = shape.params.text("filename");
  if (name.empty()) failAt(shape.place, "the plymesh needs a \"string filename\"");
  return (folder / name).lexically_normal();
}

MeshData tessellate(const Shape& shape, const fs::path& folder) {
  const Params& params = shape.params;
  MeshData mesh;
  if (shape.type == "plymesh") {
    const fs::path file = meshFileOf(shape, folder);
    if (!isRegularFile(file))
      failAt(shape.place, file.string() + ": " + whyUnreadable(file, "file") + "; check its name");
    mesh = readPly(file, readPacked(file));
    mesh.windByNormals();
    if (params.has("displacement"))
      mesh.notes.push_back("plymesh: 'displacement' of the shape is ignored");
    params.ignore({"edgelength"});
  } else if (shape.type == "trianglemesh") {
    mesh = triangleMesh(params, shape.place);
  } else if (shape.type == "bilinearmesh") {
    mesh = bilinearMesh(params, shape.place);
  } else if (shape.type == "loopsubdiv") {
    mesh = loopSubdivision(params, shape.place);
  } else if (shape.type == "sphere") {
    mesh = sphere(params);
  } else if (shape.type == "disk") {
    mesh = disk(params);
  } else if (shape.type == "cylinder") {
    mesh = cylinder(params);
  } else {
    mesh.notes.push_back("shape '" + shape.type + "' is not read; it is left out");
    for (const Param* p : params.all()) params.ignore({p->name.c_str()});
  }
  params.ignore({"alpha"});
  if (shape.reverseOrientation) mesh.reverse();
  return mesh;
}

}  // namespace bnvpl::pbrt
