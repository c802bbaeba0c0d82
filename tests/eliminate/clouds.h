// Point clouds on known surfaces, for the tests of elimination.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

struct Cloud {
  std::vector<Vec3> position, normal;
  void add(Vec3 p, Vec3 n) {
    position.push_back(p);
    normal.push_back(n);
  }
  size_t size() const { return position.size(); }
};

// Points uniformly distributed on the rectangle width x depth at z = 0, facing +z.
Cloud plane(size_t count, float width, float depth, uint64_t seed);

// Points uniformly distributed on the surface of the cube [0, edge]^3, facing outwards.
Cloud cube(size_t count, float edge, uint64_t seed);

// Points on the unit square whose density falls by about 100:1 from one side to the other.
Cloud unevenPlane(size_t count, uint64_t seed);

}  // namespace bnvpl
