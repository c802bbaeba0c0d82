// Shared by the loader tests: a temporary folder and texts of small scenes.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "scene/load_scene.h"

namespace bnvpl {

inline const std::string kFilmAndCamera =
    "[film]\nwidth = 8\nheight = 6\n"
    "[camera]\nposition = [0.0, 0.0, 5.0]\nlook_at = [0, 0, 0]\nvertical_fov_deg = 40.0\n";

// A square of side 2 in the plane z = 0 that faces +z, with texture coordinates.
inline const std::string kSquareObj =
    "mtllib square.mtl\n"
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl paint\nf 1/1 2/2 3/3 4/4\n";

class SceneFiles : public ::testing::Test {
 protected:
  SceneFiles()
      : folder_(fs::temp_directory_path() / ("bnvpl-scene-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~SceneFiles() override { fs::remove_all(folder_); }

  fs::path at(const std::string& name) const { return folder_ / name; }

  void write(const std::string& name, const std::string& bytes) const {
    fs::create_directories(at(name).parent_path());
    std::ofstream out(at(name), std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    ASSERT_TRUE(out.good()) << name;
  }

  // Writes scene.toml and loads it.
  Scene load(const std::string& toml, const Defines& defines = {}) const {
    write("scene.toml", toml);
    return loadScene(at("scene.toml"), defines);
  }
  // The error message of loading; empty when loading succeeds.
  std::string loadError(const std::string& toml, const Defines& defines = {}) const {
    try {
      load(toml, defines);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  // Loads a scene with one OBJ file and its material library.
  Scene loadMesh(const std::string& obj, const std::string& mtl, const std::string& meshKeys = "",
                 const std::string& more = "") const {
    write("square.obj", obj);
    write("square.mtl", mtl);
    return load(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n" + meshKeys + more);
  }

 private:
  fs::path folder_;
};

// An uncompressed 32-bit TGA file, rows from the top: the simplest format with an alpha channel.
inline std::string tga(uint8_t width, uint8_t height,
                       const std::vector<std::array<uint8_t, 4>>& rgba) {
  std::string bytes(18, '\0');
  bytes[2] = 2;
  bytes[12] = static_cast<char>(width);
  bytes[14] = static_cast<char>(height);
  bytes[16] = 32;
  bytes[17] = 0x28;  // 8 alpha bits, top row first
  for (const auto& p : rgba) {
    for (const size_t channel : {2u, 1u, 0u, 3u}) bytes += static_cast<char>(p[channel]);
  }
  return bytes;
}

inline size_t countContaining(const std::vector<std::string>& texts, const std::string& part) {
  size_t n = 0;
  for (const std::string& t : texts) n += t.find(part) != std::string::npos ? 1 : 0;
  return n;
}
inline std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& t : texts) all += t + "\n";
  return all;
}

inline double areaOf(const Scene& scene, uint32_t triangle) {
  const Vec3 p0 = scene.corner(triangle, 0), p1 = scene.corner(triangle, 1),
             p2 = scene.corner(triangle, 2);
  return 0.5 * double{length(cross(p1 - p0, p2 - p0))};
}
inline double areaOfMaterial(const Scene& scene, const std::string& name) {
  double sum = 0.0;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.materials[scene.triangles[t].material].name == name) sum += areaOf(scene, t);
  }
  return sum;
}
inline Vec3 geometricNormal(const Scene& scene, uint32_t t) {
  return normalize(
      cross(scene.corner(t, 1) - scene.corner(t, 0), scene.corner(t, 2) - scene.corner(t, 0)));
}
inline const Material& materialNamed(const Scene& scene, const std::string& name) {
  for (const Material& m : scene.materials) {
    if (m.name == name) return m;
  }
  throw std::out_of_range("no material " + name);
}

}  // namespace bnvpl
