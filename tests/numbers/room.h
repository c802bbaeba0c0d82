// A room with every kind of light and every kind of surface, in any unit and at any position.
#pragma once

#include <sstream>

#include "scene/affine.h"
#include "tests/scene/scene_files.h"
#include "tests/support/pipeline.h"

namespace bnvpl::test {

// Multiplies lengths in metres by `scale`, then moves them by `move` along every axis.
struct Placement {
  const char* name;
  double scale = 1.0, move = 0.0;
  bool inObj = false;  // whether the OBJ holds the final coordinates, or scene.toml the transform
};

class RoomTest : public SceneFiles {
 protected:
  // A room open towards +z, where sky and sun come in; the camera stands in the opening.
  Scene room(const Placement& p, const std::string& moreFaces = "") const {
    writeRoom(p, moreFaces);
    return load(tomlOf(p));
  }

 private:
  void writeRoom(const Placement& p, const std::string& moreFaces) const {
    write("room.mtl",
          "newmtl white\nKd 0.7 0.7 0.7\nnewmtl red\nKd 0.6 0.1 0.1\n"
          "newmtl gloss\nKd 0.3 0.3 0.3\nKs 0.3 0.3 0.3\nNs 15\nillum 2\n"
          "newmtl mirror\nKd 0 0 0\nKs 0.9 0.9 0.9\nillum 3\n"
          "newmtl glass\nNi 1.5\nillum 7\n"
          "newmtl lamp\nKd 0 0 0\nKe 12 11 10\n");
    std::ostringstream obj;
    obj << std::scientific;
    obj.precision(16);
    obj << "mtllib room.mtl\n";
    const auto corner = [&](double x, double y, double z) {
      const double s = p.inObj ? p.scale : 1.0, m = p.inObj ? p.move : 0.0;
      obj << "v " << x * s + m << " " << y * s + m << " " << z * s + m << "\n";
    };
    const auto quad = [&](const char* material, FilePoint a, FilePoint b, FilePoint c) {
      for (const FilePoint& q :
           {a, b, c, FilePoint{a[0] + c[0] - b[0], a[1] + c[1] - b[1], a[2] + c[2] - b[2]}}) {
        corner(q[0], q[1], q[2]);
      }
      obj << "usemtl " << material << "\nf -4 -3 -2 -1\n";
    };
    const auto box = [&](const char* material, FilePoint low, FilePoint high) {
      for (int i = 0; i < 8; ++i) {
        corner((i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]);
      }
      obj << "usemtl " << material
          << "\nf -8 -4 -2 -6\nf -7 -5 -1 -3\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -6 -5 -7\n"
             "f -4 -3 -1 -2\n";
    };
    quad("gloss", {-2, 0, -2}, {-2, 0, 2}, {2, 0, 2});        // floor
    quad("white", {-2, 2.5, -2}, {2, 2.5, -2}, {2, 2.5, 2});  // ceiling
    quad("white", {-2, 0, -2}, {2, 0, -2}, {2, 2.5, -2});     // back
    quad("red", {-2, 0, 2}, {-2, 0, -2}, {-2, 2.5, -2});      // left
    quad("white", {2, 0, -2}, {2, 0, 2}, {2, 2.5, 2});        // right
    quad("mirror", {-1.9, 0.5, 0}, {-1.9, 0.5, -1}, {-1.9, 1.5, -1});
    quad("lamp", {-0.4, 2.4, -1}, {0.4, 2.4, -1}, {0.4, 2.4, -0.4});
    box("white", {-1, 0, -1.2}, {-0.4, 0.7, -0.6});
    box("glass", {0.4, 0.1, -0.8}, {0.9, 0.6, -0.3});
    obj << moreFaces;
    write("room.obj", obj.str());
  }

  static std::string tomlOf(const Placement& p) {
    std::ostringstream toml;
    toml << std::scientific;
    toml.precision(16);
    const auto place = [&](double x, double y, double z) {
      std::ostringstream text;
      text.precision(17);
      text << std::scientific << "[" << x * p.scale + p.move << ", " << y * p.scale + p.move << ", "
           << z * p.scale + p.move << "]\n";
      return text.str();
    };
    const double intensity = 2.0 * p.scale * p.scale;
    toml << "[film]\nwidth = 32\nheight = 24\n[camera]\nposition = " << place(0.3, 1.2, 2.2)
         << "look_at = " << place(-0.1, 0.9, -1) << "vertical_fov_deg = 60\n"
         << "[[mesh]]\nfile = \"room.obj\"\n";
    if (!p.inObj) {
      toml << "scale = " << p.scale << "\ntranslate = [" << p.move << ", " << p.move << ", "
           << p.move << "]\n";
    }
    toml << "[[light]]\ntype = \"point\"\nposition = " << place(1, 1.5, 0) << "intensity = ["
         << intensity << ", " << intensity << ", " << intensity << "]\n"
         << "[[light]]\ntype = \"environment\"\nradiance = [0.4, 0.5, 0.8]\n"
         << "[[light]]\ntype = \"directional\"\ndirection = [0.3, -0.5, -1]\n"
            "irradiance = [3.0, 2.5, 2.0]\nangular_diameter_deg = 2\n";
    return toml.str();
  }
};

}  // namespace bnvpl::test
