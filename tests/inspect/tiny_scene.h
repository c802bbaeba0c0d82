// A wall at z = 0 seen from (0, 0, 4), and a small board at z = 1 that hides its right part.
#pragma once

#include "tests/inspect/inspect_files.h"

namespace bnvpl {

inline void writeTinyScene(const fs::path& folder) {
  writeAll(folder / "tiny.obj",
           "mtllib tiny.mtl\n"
           "v -3 -3 0\nv 3 -3 0\nv 3 3 0\nv -3 3 0\n"
           "v 0.3 -0.5 1\nv 1.2 -0.5 1\nv 1.2 0.5 1\nv 0.3 0.5 1\n"
           "usemtl white\nf 1 2 3 4\nf 5 6 7 8\n");
  writeAll(folder / "tiny.mtl", "newmtl white\nKd 0.7 0.7 0.7\nillum 1\n");
  writeAll(
      folder / "tiny.toml",
      "[film]\nwidth = 80\nheight = 60\n"
      "[camera]\nposition = [0.0, 0.0, 4.0]\nlook_at = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]\n"
      "vertical_fov_deg = 50.0\n"
      "[[mesh]]\nfile = \"tiny.obj\"\n"
      "[[light]]\ntype = \"point\"\nposition = [0.0, 2.0, 3.0]\nintensity = [1.0, 1.0, 1.0]\n");
}

// The rows are visible, hidden by the board, facing away on the board, and behind the camera.
inline VplTable tinyRows(uint64_t sceneHash) {
  VplTable table;
  table.position = {{-0.5f, 0.25f, 0}, {0.8f, 0, 0}, {0.6f, 0.1f, 1}, {0, 0, 9}};
  table.normal = {{0, 0, 1}, {0, 0, 1}, {0, 0, -1}, {0, 0, -1}};
  table.albedo.assign(4, Vec3(0.5f));
  table.id = {0, 1, 2, 3};
  table.sceneHash = sceneHash;
  return table;
}

}  // namespace bnvpl
