// Shared by the tests of the pbrt reader: small scenes in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scene/scene_files.h"

namespace bnvpl {

// A square of side 2 in the plane z = 0 whose corners run anticlockwise seen from +z.
inline const std::string kSquareShape =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"point2 uv\" [0 0 1 0 1 1 0 1]\n";

class PbrtFiles : public SceneFiles {
 protected:
  Scene loadPbrt(const std::string& text) const {
    write("scene.pbrt", text);
    return loadScene(at("scene.pbrt"));
  }
  // Loads a world of these directives and the square.
  Scene loadWorld(const std::string& world) const {
    return loadPbrt("WorldBegin\n" + world + kSquareShape);
  }
  std::string pbrtError(const std::string& text) const {
    try {
      loadPbrt(text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  // Expects an error at the place that names every part.
  void expectError(const std::string& text, const std::string& place,
                   const std::vector<std::string>& parts) const {
    const std::string error = pbrtError(text);
    EXPECT_NE(error, "") << "no error for:\n" << text;
    EXPECT_NE(error.find("scene.pbrt:" + place + ": "), std::string::npos) << error;
    for (const std::string& part : parts)
      EXPECT_NE(error.find(part), std::string::npos) << part << " not in: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  static double area(const Scene& scene) {
    double sum = 0.0;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t) sum += areaOf(scene, t);
    return sum;
  }
};

inline void expectNear(Vec3 a, Vec3 b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace bnvpl
