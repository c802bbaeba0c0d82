#include "tools/inspect/scene/write_scene.h"

#include <cmath>

#include "core/number_text.h"
#include "core/sampling.h"
#include "formats/image/exr_io.h"
#include "formats/image/png_io.h"
#include "scene/choose_view.h"
#include "scene/load_scene.h"
#include "tools/inspect/scene/scene_difference.h"

namespace bnvpl {

std::string listText(Vec3 v) {
  return "[" + shortestText(v.x) + ", " + shortestText(v.y) + ", " + shortestText(v.z) + "]";
}

namespace {

std::string placeText(const Scene& scene, Vec3 p) {
  const auto [x, y, z] = scene.origin;
  if (x == 0.0 && y == 0.0 && z == 0.0) return listText(p);
  return "[" + shortestText(p.x + x) + ", " + shortestText(p.y + y) + ", " + shortestText(p.z + z) +
         "]";
}
// Degrees that read back as exactly this angle, if a float has such a value.
std::string degText(float rad) {
  constexpr float kRadPerDeg = kPi / 180.0f;
  const auto deg = static_cast<float>(double{rad} * kDegPerRad);
  for (const float d : {deg, std::nextafter(deg, INFINITY), std::nextafter(deg, -INFINITY)}) {
    if (d * kRadPerDeg == rad) return shortestText(d);
  }
  return shortestText(deg);
}

std::string filterText(const FilterSpec& filter, const FilterSpec& guess) {
  if (filter == guess) return "";
  return std::string("filter = \"") + nameOf(filter.kind) +
         "\"\nfilter_radius = " + shortestText(filter.radius) + "\n";
}

// What a reader assumes of a view that does not say it.
struct Guess {
  bool mirrored = false;
  FilterSpec filter = {};
};

std::string viewText(const Scene& scene, const Film& film, const Camera& c, const Guess& guess) {
  std::string text = "[film]\nwidth = " + std::to_string(film.width) +
                     "\nheight = " + std::to_string(film.height) + "\n" +
                     filterText(film.filter, guess.filter) +
                     "\n[camera]\nposition = " + placeText(scene, c.position) +
                     "\nforward = " + listText(c.forward) + "\nup = " + listText(c.up) +
                     "\nvertical_fov_deg = " + degText(c.verticalFovRad) + "\n";
  if (c.shift != std::array<float, 2>{})
    text += "shift = [" + shortestText(c.shift[0]) + ", " + shortestText(c.shift[1]) + "]\n";
  if (c.hasLens()) {
    text += "lens_radius = " + shortestText(c.lensRadius) +
            "\nfocus_distance = " + shortestText(c.focusDistance) + "\n";
  }
  if (c.isMirrored() != guess.mirrored)
    text += std::string("mirrored = ") + (guess.mirrored ? "false\n" : "true\n");
  return text;
}

std::string environmentFile(size_t number) {
  return "textures/environment-" + std::to_string(number) + ".exr";
}

std::string lightText(const Scene& scene, const LightSpec& l) {
  std::string text = "\n[[light]]\n";
  const auto add = [&](const char* key, const std::string& value) {
    text += std::string(key) + " = " + value + "\n";
  };
  if (!l.name.empty()) add("name", inQuotes(l.name));
  if (l.group > 0) add("group", inQuotes(scene.lightGroups[l.group]));
  switch (l.type) {
    case LightType::Point:
    case LightType::Spot:
      add("type", l.type == LightType::Point ? "\"point\"" : "\"spot\"");
      add("position", placeText(scene, l.position));
      add("intensity", listText(l.emission));
      if (l.type == LightType::Point) break;
      add("direction", listText(l.direction));
      add("cone_deg", degText(l.coneRad));
      add("falloff_deg", degText(l.falloffRad));
      break;
    case LightType::Directional:
      add("type", "\"directional\"");
      add("direction", listText(l.direction));
      add("irradiance", listText(l.emission));
      add("angular_diameter_deg", degText(2.0f * l.angularRadiusRad));
      break;
    case LightType::Environment:
      add("type", "\"environment\"");
      if (l.image == kNone)
        add("radiance", listText(l.emission));
      else
        add("image", "\"" + environmentFile(l.image) + "\"");
      add("rotate_deg", degText(l.rotateRad));
      add("scale", shortestText(l.scale));
      break;
  }
  return text;
}

// The light groups of emissive materials.
std::string materialGroupsText(const Scene& scene, const WrittenMaterials& used) {
  std::string text;
  for (const uint32_t m : used.materials) {
    const uint32_t group = scene.materials[m].lightGroup;
    if (group == 0) continue;
    text += "\n[[light]]\ntype = \"material\"\nmaterial = " + inQuotes(used.names[m]) +
            "\ngroup = " + inQuotes(scene.lightGroups[group]) + "\n";
  }
  return text;
}

std::string instanceText(const Scene& scene, size_t number,
                         const std::vector<std::string>& objects) {
  const Instance& instance = scene.instances[number];
  const uint32_t object = scene.instanceObjects[number];
  std::string text = "\n[[mesh.instance]]\n";
  if (object != kNone) text += "name = " + inQuotes(objects[object]) + "\n";
  text += "transform = [";
  for (size_t r = 0; r < 3; ++r) {
    const float* row = &instance.toWorld[4 * r];
    text += "[";
    for (size_t c = 0; c < 3; ++c) text += shortestText(row[c]) + ", ";
    text += shortestText(row[3] + scene.origin[r]) + "], ";
  }
  return text + "[0, 0, 0, 1]]\n";
}

void writeText(OutputFolder& folder, const std::string& name, const std::string& text) {
  AtomicFile file(folder.add(name));
  file.write(text);
  file.commit();
}

// Writes the world, and each prototype with its instances; returns their TOML.
std::string writeMeshes(const Scene& scene, const std::vector<std::string>& names,
                        OutputFolder& folder) {
  const std::vector<std::string> objects = objectNames(scene);
  std::string toml;
  const auto write = [&](const std::string& name, uint32_t begin, uint32_t end) {
    writeText(folder, name, objText(scene, begin, end, names, objects));
    toml += "\n[[mesh]]\nfile = \"" + name + "\"\n";
  };
  if (scene.worldEnd() > 0) write("scene.obj", 0, scene.worldEnd());
  std::vector<std::string> instances(scene.prototypes.size());
  for (size_t i = 0; i < scene.instances.size(); ++i)
    instances[scene.instances[i].prototype] += instanceText(scene, i, objects);
  for (size_t p = 0; p < scene.prototypes.size(); ++p) {
    if (instances[p].empty()) continue;
    write("instanced-" + std::to_string(p) + ".obj", scene.prototypes[p].begin,
          scene.prototypes[p].end);
    toml += instances[p];
  }
  return toml;
}

void writeFloats(const Texture& t, AtomicFile& file) {
  Image image;
  image.width = static_cast<int>(t.width);
  image.height = static_cast<int>(t.height);
  for (size_t k = 0; k < (t.hasAlpha() ? 4u : 3u); ++k) {
    std::vector<float>& channel = image.add(std::string(1, "RGBA"[k]));
    for (size_t p = 0; p < channel.size(); ++p) channel[p] = t.floats[4 * p + k];
  }
  writeExr(file, image, ExrPixelType::Float);
}

void writeTexture(const Scene& scene, uint32_t number, OutputFolder& folder) {
  const Texture& t = scene.textures[number];
  AtomicFile file(folder.add(textureFile(scene, number)));
  if (!t.floats.empty()) {
    writeFloats(t, file);
    file.commit();
    return;
  }
  bool opaque = true;
  for (size_t i = 3; i < t.rgba.size(); i += 4) opaque = opaque && t.rgba[i] == 255;
  std::vector<uint8_t> pixels;
  pixels.reserve(t.rgba.size());
  for (size_t i = 0; i < t.rgba.size(); ++i) {
    if (!opaque || i % 4 < 3) pixels.push_back(t.rgba[i]);
  }
  writePng(file, static_cast<int>(t.width), static_cast<int>(t.height), pixels, opaque ? 3 : 4);
  file.commit();
}

void writeEnvironment(const EnvironmentImage& e, const std::string& name, OutputFolder& folder) {
  Image image;
  image.width = static_cast<int>(e.width);
  image.height = static_cast<int>(e.height);
  for (size_t k = 0; k < 3; ++k) {
    std::vector<float>& channel = image.add(std::string(1, "RGB"[k]));
    for (size_t p = 0; p < e.radiance.size(); ++p) channel[p] = e.radiance[p][k];
  }
  AtomicFile file(folder.add(name));
  writeExr(file, image, ExrPixelType::Float);
  file.commit();
}

// Throws OutputError unless the written scene reads back as the given one.
void requireSame(const Scene& scene, const OutputFolder& folder) {
  const fs::path file = folder.partial() / "scene.toml";
  std::string difference;
  try {
    difference = sceneDifference(scene, loadScene(file));
  } catch (const InputError& e) {
    difference = e.what();
    for (size_t at; (at = difference.find(folder.partial().string())) != std::string::npos;)
      difference.replace(at, folder.partial().string().size(), folder.target().string());
  }
  if (!difference.empty())
    throw OutputError(folder.target(), "scene.toml cannot state this scene: " + difference);
}

}  // namespace

std::string textureFile(const Scene& scene, uint32_t texture) {
  const bool floats = !scene.textures[texture].floats.empty();
  return "textures/" + std::to_string(texture) + (floats ? ".exr" : ".png");
}

UvTransform uvOfImage(const Scene& scene, const TextureExpression& image) {
  const Texture& t = scene.textures[image.image];
  const UvTransform& uv = image.uv;
  return {uv.a * t.scale[0], uv.b * t.scale[0], uv.c * t.scale[0] + t.offset[0],
          uv.d * t.scale[1], uv.e * t.scale[1], uv.f * t.scale[1] + t.offset[1]};
}

void writeSceneToml(const Scene& scene, OutputFolder& folder) {
  WrittenMaterials used{materialNames(scene), {}, {}};
  for (const Triangle& t : scene.triangles) used.materials.insert(t.material);
  const std::string meshes = writeMeshes(scene, used.names, folder);
  writeText(folder, "scene.mtl", mtlText(scene, used));
  std::string toml =
      viewText(scene, scene.film, scene.camera, {}) + surfacesText(scene, used) + meshes;
  toml += materialGroupsText(scene, used);
  for (const LightSpec& light : scene.lights) toml += lightText(scene, light);
  writeText(folder, "scene.toml", toml);
  for (size_t i = 0; scene.views.size() > 1 && i < scene.views.size(); ++i) {
    const Guess guess{scene.camera.isMirrored(), scene.film.filter};
    writeText(folder, "view-" + std::to_string(i) + ".toml",
              viewText(scene, scene.views[i].film, scene.views[i].camera, guess));
  }
  for (const uint32_t texture : used.textures) writeTexture(scene, texture, folder);
  for (size_t i = 0; i < scene.environments.size(); ++i)
    writeEnvironment(scene.environments[i], environmentFile(i), folder);
  requireSame(scene, folder);
}

}  // namespace bnvpl
