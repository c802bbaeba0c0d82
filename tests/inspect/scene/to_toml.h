// Conversion of scenes by vpl-inspect scene --to-toml.
#pragma once

#include "formats/image/png_io.h"
#include "scene/load_scene.h"
#include "tests/inspect/run_inspect.h"
#include "tests/inspect/tiny_scene.h"
#include "tools/inspect/scene/scene_difference.h"

namespace bnvpl {

inline const std::string kPbrtView =
    "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
inline const std::string kSquare =
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] \"integer indices\" "
    "[0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1]\n";
inline const std::string kView =
    "[film]\nwidth = 32\nheight = 24\n[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n"
    "vertical_fov_deg = 40\n";

class ToToml : public InspectTest {
 protected:
  static std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }
  Outcome convert(const std::string& name, const std::string& to, const std::string& more = "") {
    return runInspect("scene " + quoted(at(name)) + " --to-toml " + quoted(at(to)) + " " + more);
  }
  // Converts the scene, converts the result again, and expects both copies to equal the original.
  Scene copyOf(const std::string& name) {
    for (const char* folder : {"copy", "copy of copy"}) {
      const Outcome done =
          convert(folder == std::string("copy") ? name : "copy/scene.toml", folder);
      EXPECT_EQ(done.code, 0) << done.output;
    }
    const Scene scene = loadScene(at(name)), copy = loadScene(at("copy/scene.toml"));
    EXPECT_EQ(sceneDifference(scene, copy), "");
    EXPECT_EQ(sceneDifference(scene, loadScene(at("copy of copy/scene.toml"))), "");
    EXPECT_TRUE(copy.warnings.empty()) << copy.warnings.front();
    return copy;
  }
  Scene copyOfPbrt(const std::string& world) {
    writeAll(at("s.pbrt"), kPbrtView + world);
    return copyOf("s.pbrt");
  }
  void writePicture(const std::string& name) const {  // 2 x 2: red, green, blue, grey
    writePng(at(name), 2, 2, std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 90, 90, 90});
  }
  template <typename Model>
  static const Model& modelOf(const Scene& scene) {
    return std::get<Model>(scene.materials.at(scene.triangles.at(0).material).model);
  }
  void writeTinyWith(const std::string& more) const {
    writeTinyScene(at("."));
    writeAll(at("tiny.toml"), readAll(at("tiny.toml")) + more);
  }
  void writeTinyAs(const std::string& name) const {
    writeTinyScene(at("."));
    fs::rename(at("tiny.toml"), at(name));
  }
};

}  // namespace bnvpl
