// Checks for every BSDF model: energy, reciprocity, and consistency of value, density and samples.
// The test of a model calls check() for its materials and adds known numbers.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/transport/plain_scene.h"

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

// The origin seen from w: from below, normals and front change sides.
inline SurfacePoint seenFrom(Vec3 w, Vec3 ns = {0, 0, 1}, bool insideOut = false) {
  const float side = w.z < 0.0f ? -1.0f : 1.0f;
  SurfacePoint p = pointSeenFrom(w, {0, 0, side}, ns * side, (side > 0.0f) != insideOut);
  p.tangent = {1, 0, 0};
  return p;
}

// Cells of the sphere of directions, with the samples drawn in each and the density's integral.
class SphereCells {
 public:
  static constexpr int kRows = 20, kColumns = 24;
  void draw(Vec3 w) { drawn_[cellOf(w)] += 1.0; }
  // Integrates the density by the midpoint rule within each cell, for `count` samples in total.
  void integrate(const std::function<float(Vec3)>& pdf, double count);
  double sumExpected() const;
  // Chi-square over cells (small ones pooled) as a standard normal deviate (Wilson & Hilferty).
  double deviate() const;

 private:
  static size_t cellOf(Vec3 w);
  std::vector<double> drawn_ = std::vector<double>(kRows * kColumns), expected_ = drawn_;
};

// Calls fn with `count` samples stratified over the lobe choice and the unit square.
void forEachSample(const Bsdf& bsdf, LobeGroup group, TransportMode transport, uint32_t count,
                   const std::function<void(const BsdfSample&)>& fn);
Vec3 meanWeight(const Bsdf& bsdf, LobeGroup group,
                TransportMode transport = TransportMode::Radiance, uint32_t count = 1u << 15);
// Reflected and transmitted flux in a white furnace.
Vec3 furnace(const Material& m, Vec3 wo, bool insideOut = false);

// Chi-square test of samples against the density, and of the density's integral against the share
// of samples that leave.
void checkDensity(const Bsdf& bsdf, LobeGroup group, const std::string& name);
// For each sample, value * cosine equals weight * density. A photon that travels from wo to wi is
// scattered like radiance that travels the same way: reciprocity, with refraction and shading
// normals taken into account (Veach 1997, sections 5.2 and 5.3).
void checkSamples(const Scene& scene, Vec3 wo, Vec3 ns, LobeGroup group, const std::string& name);
// roughUpperBound() holds for cones of directions.
void checkBound(const Bsdf& bsdf, const std::string& name);
// Checks for any material. `tolerance` applies to the furnace and to the stated rough albedo.
void check(const Material& m, const std::string& material, float tolerance = 0.01f);

}  // namespace bnvpl::test
