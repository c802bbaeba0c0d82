#include "tools/inspect/write_scene.h"

#include <numbers>

#include "core/number_text.h"
#include "formats/exr_io.h"
#include "formats/png_io.h"
#include "scene/affine.h"

namespace bnvpl {

namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

FilePoint filePlace(const Scene& scene, Vec3 p) {
  return {p.x + scene.origin[0], p.y + scene.origin[1], p.z + scene.origin[2]};
}

std::string listText(const FilePoint& p) {
  return "[" + shortestText(p[0]) + ", " + shortestText(p[1]) + ", " + shortestText(p[2]) + "]";
}
std::string listText(Vec3 v) { return listText(FilePoint{v.x, v.y, v.z}); }
std::string degText(float rad) { return shortestText(double{rad} * kDegPerRad); }

// Consecutive triangles of a material stand together; the order is the scene's.
std::string objText(const Scene& scene) {
  std::string text = "mtllib scene.mtl\n";
  for (size_t i = 0; i + 1 < scene.positions.size(); ++i) {
    const FilePoint p = filePlace(scene, scene.positions[i]);
    text += "v " + shortestText(p[0]) + " " + shortestText(p[1]) + " " + shortestText(p[2]) + "\n";
  }
  for (const Vec3 n : scene.normals)
    text += "vn " + shortestText(n.x) + " " + shortestText(n.y) + " " + shortestText(n.z) + "\n";
  for (const auto& [u, v] : scene.uvs)
    text += "vt " + shortestText(u) + " " + shortestText(v) + "\n";
  uint32_t material = kNone;
  for (const Triangle& t : scene.triangles) {
    if (t.material != material) text += "usemtl " + mtlName(scene, t.material) + "\n";
    material = t.material;
    text += "f";
    for (size_t k = 0; k < 3; ++k) {
      text += " " + std::to_string(t.position[k] + 1);
      if (t.uv[k] != kNone) text += "/" + std::to_string(t.uv[k] + 1);
      if (t.normal[k] != kNone)
        text += (t.uv[k] != kNone ? "/" : "//") + std::to_string(t.normal[k] + 1);
    }
    text += "\n";
  }
  return text;
}

std::string viewText(const Scene& scene, const Film& film, const Camera& c) {
  return "[film]\nwidth = " + std::to_string(film.width) +
         "\nheight = " + std::to_string(film.height) +
         "\n\n[camera]\nposition = " + listText(filePlace(scene, c.position)) +
         "\nforward = " + listText(c.forward) + "\nup = " + listText(c.up) +
         "\nvertical_fov_deg = " + degText(c.verticalFovRad) + "\n" +
         (c.shift == std::array<float, 2>{}
              ? ""
              : "shift = [" + shortestText(c.shift[0]) + ", " + shortestText(c.shift[1]) + "]\n");
}

std::string lightText(const Scene& scene, const LightSpec& l) {
  std::string text = "\n[[light]]\n";
  const auto add = [&](const char* key, const std::string& value) {
    text += std::string(key) + " = " + value + "\n";
  };
  switch (l.type) {
    case LightType::Point:
    case LightType::Spot:
      add("type", l.type == LightType::Point ? "\"point\"" : "\"spot\"");
      add("position", listText(filePlace(scene, l.position)));
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
        add("image", "\"textures/environment-" + std::to_string(l.image) + ".exr\"");
      add("rotate_deg", degText(l.rotateRad));
      add("scale", shortestText(double{l.scale}));
      break;
  }
  return text;
}

// Colours; of a mask its alpha, as grey.
std::vector<uint8_t> rgbOf(const Scene& scene, uint32_t number) {
  const Texture& t = scene.textures[number];
  if (!t.floats.empty())
    throw InputError(t.name, "has floats, which a PNG cannot hold; convert it to 8 bits first");
  bool mask = false;
  for (const Material& m : scene.materials) mask = mask || m.opacityMap == number;
  std::vector<uint8_t> rgb;
  rgb.reserve(size_t{3} * t.width * t.height);
  for (size_t i = 0; i < t.rgba.size(); i += 4) {
    for (size_t k = 0; k < 3; ++k) rgb.push_back(t.rgba[i + (mask ? 3 : k)]);
  }
  return rgb;
}

void writeImages(const Scene& scene, const fs::path& folder, OutputSet& files) {
  for (uint32_t i = 0; i < scene.textures.size(); ++i) {
    writePng(files.add(folder / "textures" / (std::to_string(i) + ".png")),
             static_cast<int>(scene.textures[i].width), static_cast<int>(scene.textures[i].height),
             rgbOf(scene, i));
  }
  for (size_t i = 0; i < scene.environments.size(); ++i) {
    const EnvironmentImage& e = scene.environments[i];
    Image image;
    image.width = static_cast<int>(e.width);
    image.height = static_cast<int>(e.height);
    for (size_t k = 0; k < 3; ++k) {
      std::vector<float>& channel = image.add(std::string(1, "RGB"[k]));
      for (size_t p = 0; p < e.radiance.size(); ++p) channel[p] = e.radiance[p][k];
    }
    writeExr(files.add(folder / "textures" / ("environment-" + std::to_string(i) + ".exr")), image,
             ExrPixelType::Float);
  }
}

}  // namespace

void createSceneFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "textures", error);
  if (error) throw OutputError(folder, "cannot create the folder: " + error.message());
}

std::vector<std::string> writeSceneToml(const Scene& scene, const fs::path& folder,
                                        OutputSet& files) {
  std::string toml =
      viewText(scene, scene.film, scene.camera) + "\n[[mesh]]\nfile = \"scene.obj\"\n";
  for (const LightSpec& light : scene.lights) toml += lightText(scene, light);
  files.add(folder / "scene.toml").write(toml);
  files.add(folder / "scene.obj").write(objText(scene));
  std::vector<std::string> approximated;
  files.add(folder / "scene.mtl").write(mtlText(scene, approximated));
  for (size_t i = 0; scene.views.size() > 1 && i < scene.views.size(); ++i) {
    files.add(folder / ("view-" + std::to_string(i) + ".toml"))
        .write(viewText(scene, scene.views[i].film, scene.views[i].camera));
  }
  writeImages(scene, folder, files);
  return approximated;
}

}  // namespace bnvpl
