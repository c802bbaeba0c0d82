// A closed room of known energy.
#pragma once

#include "tests/support/pipeline.h"

namespace bnvpl::test {

// A closed cube of edge 1 about (1/2, 1/2, 1/2) with albedo 1/2. It holds a point light for each
// intensity, in W/sr, all at one position.
inline World greyCube(const std::vector<Vec3>& intensities) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "furnace/scene.toml");
  for (Material& m : scene.materials) m.emission = {};
  for (const Vec3 intensity : intensities) {
    LightSpec l;
    l.position = {0.4f, 0.5f, 0.6f};
    l.emission = intensity;
    scene.lights.push_back(l);
  }
  return World(std::move(scene));
}

}  // namespace bnvpl::test
