#include "tests/eliminate/clouds.h"

#include "core/random.h"

namespace bnvpl {

Cloud plane(size_t count, float width, float depth, uint64_t seed) {
  Cloud cloud;
  for (size_t i = 0; i < count; ++i) {
    Rng rng(seed, i);
    const float x = rng.next(), y = rng.next();
    cloud.add({width * x, depth * y, 0.0f}, {0, 0, 1});
  }
  return cloud;
}

Cloud cube(size_t count, float edge, uint64_t seed) {
  Cloud cloud;
  for (size_t i = 0; i < count; ++i) {
    Rng rng(seed, i);
    const size_t axis = std::min<size_t>(2, static_cast<size_t>(rng.next() * 3.0f));
    const bool far = rng.next() < 0.5f;
    Vec3 p, n;
    p[axis] = far ? edge : 0.0f;
    n[axis] = far ? 1.0f : -1.0f;
    p[(axis + 1) % 3] = edge * rng.next();
    p[(axis + 2) % 3] = edge * rng.next();
    cloud.add(p, n);
  }
  return cloud;
}

Cloud unevenPlane(size_t count, uint64_t seed) {
  Cloud cloud;
  for (size_t i = 0; i < count; ++i) {
    Rng rng(seed, i);
    const float x = rng.next(), y = rng.next();
    cloud.add({std::pow(100.0f, x - 1.0f), y, 0.0f}, {0, 0, 1});
  }
  return cloud;
}

}  // namespace bnvpl
