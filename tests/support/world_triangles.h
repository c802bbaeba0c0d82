// All triangles of a scene at their places: those of the world, then each instance's.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace bnvpl::test {

inline std::vector<std::array<Vec3, 3>> worldTriangles(const Scene& s) {
  std::vector<std::array<Vec3, 3>> out;
  for (uint32_t t = 0; t < s.worldEnd(); ++t)
    out.push_back({s.corner(t, 0), s.corner(t, 1), s.corner(t, 2)});
  for (const Instance& i : s.instances)
    for (uint32_t t = s.prototypes[i.prototype].begin; t < s.prototypes[i.prototype].end; ++t)
      out.push_back({i.point(s.corner(t, 0)), i.point(s.corner(t, 1)), i.point(s.corner(t, 2))});
  return out;
}

}  // namespace bnvpl::test
