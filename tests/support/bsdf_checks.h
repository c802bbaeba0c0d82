// What holds for every model of materials: energy, reciprocity, and value, density and samples that
// agree. The test of a model calls check() for its materials and adds the numbers that it knows.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/scene/plain_scene.h"

namespace bnvpl::test {

inline constexpr LobeGroup kGroups[] = {LobeGroup::Rough, LobeGroup::Specular};

template <typename Model>
Material materialOf(const Model& model) {
  Material m;
  m.model = model;
  return m;
}

inline const std::vector<Vec3>& views() {
  static const std::vector<Vec3> all{normalize({0.001f, 0, 1}), normalize({1, 0.4f, 1}),
                                     normalize({-1, 0.3f, 0.3f})};
  return all;
}

// The same place seen from w: from below, normals and front change sides.
inline SurfacePoint seenFrom(Vec3 w, Vec3 ns = {0, 0, 1}, bool insideOut = false) {
  const float side = w.z < 0.0f ? -1.0f : 1.0f;
  SurfacePoint p = pointSeenFrom(w, {0, 0, side}, ns * side, (side > 0.0f) != insideOut);
  p.tangent = {1, 0, 0};
  return p;
}

// Cells of the sphere of directions, with the samples and the density that fall into each.
class SphereCells {
 public:
  static constexpr int kRows = 20, kColumns = 24;
  void draw(Vec3 w) { drawn_[cellOf(w)] += 1.0; }
  // Midpoint rule within each cell, count samples in all.
  void integrate(const std::function<float(Vec3)>& pdf, double count);
  double sumExpected() const;
  // Chi-square over cells (small ones pooled), as the deviate of a normal variable (Wilson &
  // Hilferty).
  double deviate() const;

 private:
  static size_t cellOf(Vec3 w);
  std::vector<double> drawn_ = std::vector<double>(kRows * kColumns), expected_ = drawn_;
};

// Stratified over pick and the square.
void forEachSample(const Bsdf& bsdf, LobeGroup group, Transport transport, uint32_t count,
                   const std::function<void(const BsdfSample&)>& fn);
Vec3 meanWeight(const Bsdf& bsdf, LobeGroup group, Transport transport = Transport::Radiance,
                uint32_t count = 1u << 15);
// What a white furnace shows: all light that leaves, as flux.
Vec3 furnace(const Material& m, Vec3 wo, bool insideOut = false);

// Chi-square of samples against density, and the density's integral against the share of samples
// that leave.
void checkDensity(const Bsdf& bsdf, LobeGroup group, const std::string& name);
// value * cosine is weight * density of each sample; and a photon that goes from wo to wi is
// scattered as radiance that goes the same way: reciprocity, with refraction and shading normals
// accounted for (Veach 1997, sections 5.2 and 5.3).
void checkSamples(const Scene& scene, Vec3 wo, Vec3 ns, LobeGroup group, const std::string& name);
// roughUpperBound() holds for cones of directions.
void checkBound(const Bsdf& bsdf, const std::string& name);
// Everything that any material keeps to. `tolerance`: of the furnace and of the stated rough
// albedo.
void check(const Material& m, const std::string& material, float tolerance = 0.01f);

}  // namespace bnvpl::test
