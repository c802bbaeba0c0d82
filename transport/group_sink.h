// Light by light group (Scene::lightGroups). Estimators return the light of all lights together.
// Where a sink is given, they also add the part of each light to the sum of its group, with the
// same random numbers, weights and decisions, so that the groups add up to what they return.
#pragma once

#include <cstdint>
#include <span>

#include "core/vec3.h"

namespace bnvpl {

// Where an estimator adds light by group, and the factor that its light has there.
struct LightGroupSink {
  Vec3* sums = nullptr;  // one for each group; null: none are wanted
  Vec3 factor{1.0f};

  explicit operator bool() const { return sums != nullptr; }
  void add(uint32_t group, Vec3 light) const { sums[group] += factor * light; }
  LightGroupSink times(Vec3 f) const { return {sums, factor * f}; }
  LightGroupSink times(float f) const { return {sums, factor * f}; }
};

// Adds to `sums`; to nothing if there are none.
inline LightGroupSink sinkTo(std::span<Vec3> sums) {
  return {sums.empty() ? nullptr : sums.data()};
}

}  // namespace bnvpl
