#include "scene/read/toml/toml_meshes.h"

#include <algorithm>
#include <numbers>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/obj/load_obj.h"

namespace bnvpl {

namespace {

// Files that people have beside a scene, and that no reader takes.
constexpr std::array kOtherFormats{".blend", ".fbx", ".dae", ".usd", ".usda", ".usdc", ".usdz",
                                   ".stl",   ".ply", ".3ds", ".abc", ".xml",  ".max",  ".mtl"};

const std::vector<std::string> kInstanceKeys{"name", "transform", "translate", "rotate_deg",
                                             "scale"};

Affine readMatrix(const TomlSection& s) {
  const auto rows = s.rows("transform", 4, 4);
  if (rows[3] != std::vector<double>{0, 0, 0, 1})
    s.fail(s.node("transform"), "the last row of 'transform' must be 0, 0, 0, 1");
  Affine a;
  for (size_t i = 0; i < 3; ++i) std::ranges::copy(rows[i], a.m[i].begin());
  return a;
}

Affine readTransform(const TomlSection& s) {
  const bool parts = s.has("translate") || s.has("rotate_deg") || s.has("scale");
  if (s.has("transform")) {
    if (parts) s.fail("has 'transform' and translate/rotate_deg/scale; use one or the other");
    return readMatrix(s);
  }
  FilePoint scale{1, 1, 1}, rotate{}, translate{};
  if (s.has("scale")) {
    if (s.node("scale").is_array())
      scale = s.point("scale");
    else
      scale.fill(s.number("scale", -TomlSection::kMaxMagnitude, TomlSection::kMaxMagnitude));
  }
  if (s.has("rotate_deg")) rotate = s.point("rotate_deg");
  for (double& angle : rotate) angle *= std::numbers::pi / 180.0;
  if (s.has("translate")) translate = s.point("translate");
  return Affine::fromParts(translate, rotate, scale);
}

uint32_t nameOf(const TomlSection& s, SceneBuilder& builder) {
  return s.has("name") ? builder.addObject(s.newName({})) : kNone;
}

std::vector<SceneBuilder::Place> readInstances(const fs::path& file, const toml::table& table,
                                               SceneBuilder& builder) {
  std::vector<SceneBuilder::Place> out;
  for (const toml::table* t : tablesOf(file, table, "instance", "mesh.instance")) {
    const TomlSection s(file, "[[mesh.instance]]", *t, kInstanceKeys);
    out.push_back({readTransform(s), nameOf(s, builder)});
  }
  return out;
}

// Adds a whole scene file: meshes, materials, lights and cameras.
void include(const TomlSection& s, const fs::path& path, const FileNames& names,
             std::vector<SceneBuilder::Place> instances, SceneBuilder& builder) {
  const toml::node& at = s.node("file");
  if (s.has("materials")) {
    s.fail(
        s.node("materials"),
        "'materials' replaces those of an OBJ; those of other files by a [[material]] of the same "
        "name");
  }
  if (const std::string problem = builder.whyNotInclude(path); !problem.empty())
    s.fail(at, path.string() + " " + problem);
  builder.beginInclude(path, readTransform(s), std::move(instances));
  readSceneFile(path, names.defines(), builder);
  builder.endInclude();
}

void readMesh(const fs::path& file, const toml::table& table, const FileNames& names,
              SceneBuilder& builder) {
  const TomlSection s(
      file, "[[mesh]]", table,
      {"file", "materials", "transform", "translate", "rotate_deg", "scale", "instance"});
  const fs::path path = names.resolve(s, "file");
  const auto require = [&](const char* key, const fs::path& named, const char* what) {
    if (isRegularFile(named)) return;
    s.fail(s.node(key), named.string() + ": " + whyUnreadable(named, what) + "; check its name");
  };
  const bool several = s.has("instance");
  std::vector<SceneBuilder::Place> instances;
  if (several) instances = readInstances(file, table, builder);
  if (several && instances.empty())
    return builder.warn(s.where("instance") +
                        "'instance' is an empty list, so that the mesh stands nowhere");
  const bool readable = std::ranges::count(kOtherFormats, lowerExtension(path)) == 0;
  const bool whole = isSceneFile(path) && lowerExtension(path) != ".obj";
  if (readable) require("file", path, whole ? "file" : "OBJ file");
  if (whole) return include(s, path, names, std::move(instances), builder);
  if (!readable) {
    s.fail(s.node("file"), path.string() + " is no file that is read; export it as glTF (.glb)");
  }
  const fs::path materials = s.has("materials") ? names.resolve(s, "materials") : fs::path();
  if (s.has("materials")) require("materials", materials, "MTL file");
  if (!several) return loadObj(path, materials, readTransform(s), builder);
  const uint32_t prototype = builder.beginPrototype();
  loadObj(path, materials, readTransform(s), builder);
  builder.endPrototype();
  for (const auto& [toScene, object] : instances) builder.addInstance(prototype, toScene, object);
}

}  // namespace

void readTomlMeshes(const fs::path& file, const toml::table& root, const FileNames& names,
                    SceneBuilder& builder) {
  const auto meshes = tablesOf(file, root, "mesh");
  if (meshes.empty())
    throw InputError(file, "has no triangle; name at least one OBJ or scene file in a [[mesh]]");
  for (const toml::table* t : meshes) readMesh(file, *t, names, builder);
}

}  // namespace bnvpl
