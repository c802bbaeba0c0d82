#include "tests/support/bsdf_checks.h"

#include <cmath>

namespace bnvpl::test {

void SphereCells::integrate(const std::function<float(Vec3)>& pdf, double count) {
  // Rows are uniform in angle, not in cosine: finest at the poles, where lobes are.
  constexpr int kFineRows = 48, kFineColumns = 10;
  for (int i = 0; i < kRows * kFineRows; ++i) {
    const int row = i / kFineRows;
    const double from = std::acos(2.0 * (row + 1.0) / kRows - 1.0),
                 step = (std::acos(2.0 * row / kRows - 1.0) - from) / kFineRows;
    const double theta = from + (i % kFineRows + 0.5) * step, r = std::sin(theta);
    const double area = step * r * 2.0 * double{kPi} / (kColumns * kFineColumns);
    for (int j = 0; j < kColumns * kFineColumns; ++j) {
      const double phi = 2.0 * double{kPi} * (j + 0.5) / (kColumns * kFineColumns);
      const Vec3 w{float(r * std::cos(phi)), float(r * std::sin(phi)), float(std::cos(theta))};
      expected_[size_t(row * kColumns + j / kFineColumns)] += double{pdf(w)} * area * count;
    }
  }
}

double SphereCells::sumExpected() const {
  double sum = 0.0;
  for (const double e : expected_) sum += e;
  return sum;
}

double SphereCells::deviate() const {
  double chi2 = 0.0, pooledDrawn = 0.0, pooledExpected = 0.0;
  int cells = 0;
  for (size_t i = 0; i < drawn_.size(); ++i) {
    if (expected_[i] < 20.0) {
      pooledDrawn += drawn_[i], pooledExpected += expected_[i];
      continue;
    }
    // The quadrature error, 1/500 of a cell, is not an error of the sampling.
    const double variance = expected_[i] + std::pow(expected_[i] / 500, 2);
    chi2 += std::pow(drawn_[i] - expected_[i], 2) / variance;
    ++cells;
  }
  if (pooledExpected >= 5.0) {
    chi2 += std::pow(pooledDrawn - pooledExpected, 2) / pooledExpected;
    ++cells;
  } else if (pooledDrawn > 30.0) {
    return 99.0;  // samples where the density is 0
  }
  const double dof = std::max(1, cells);
  return (std::cbrt(chi2 / dof) - (1.0 - 2.0 / (9.0 * dof))) / std::sqrt(2.0 / (9.0 * dof));
}

size_t SphereCells::cellOf(Vec3 w) {
  const int row = std::clamp(int((w.z + 1.0f) * 0.5f * kRows), 0, kRows - 1);
  const float turn = std::atan2(w.y, w.x) / (2.0f * kPi);
  const int column = std::clamp(int((turn < 0 ? turn + 1.0f : turn) * kColumns), 0, kColumns - 1);
  return size_t(row * kColumns + column);
}

// The samples are stratified over the lobe choice and the unit square.
void forEachSample(const Bsdf& bsdf, LobeGroup group, TransportMode transport, uint32_t count,
                   const std::function<void(const BsdfSample&)>& fn) {
  for (uint32_t i = 0; i < count; ++i) {
    const Point2 at = owenSobol(i, 77);
    const float pick = toUnitFloat(uint64_t{owenScramble(i * 0x9e3779b9u, 5)} << 32);
    BsdfSample s;
    if (bsdf.sample(group, transport, pick, at, s)) fn(s);
  }
}
Vec3 meanWeight(const Bsdf& bsdf, LobeGroup group, TransportMode transport, uint32_t count) {
  double sum[3] = {};
  forEachSample(bsdf, group, transport, count, [&](const BsdfSample& s) {
    for (size_t c = 0; c < 3; ++c) sum[c] += double{s.weight[c]};
  });
  return Vec3(float(sum[0] / count), float(sum[1] / count), float(sum[2] / count));
}
// Reflected and transmitted flux in a white furnace.
Vec3 furnace(const Material& m, Vec3 wo, bool insideOut) {
  const Scene scene = sceneOf(m);
  const SurfacePoint p = seenFrom(wo, {0, 0, 1}, insideOut);
  const Bsdf bsdf(scene, p);
  return meanWeight(bsdf, LobeGroup::Rough, TransportMode::Importance) +
         meanWeight(bsdf, LobeGroup::Specular, TransportMode::Importance);
}

// Chi-square test of samples against the density, and of the density's integral against the share
// of samples that leave. The test needs independent samples.
void checkDensity(const Bsdf& bsdf, LobeGroup group, const std::string& name) {
  constexpr int kCount = 60000;
  SphereCells cells;
  int left = 0, sharp = 0;
  for (int i = 0; i < kCount; ++i) {
    Rng rng(19, uint64_t(i));
    BsdfSample s;
    if (!bsdf.sample(group, TransportMode::Radiance, rng, s)) continue;
    if (s.pdf == 0.0f) {
      ++sharp;
      continue;
    }
    ++left;
    cells.draw(s.wi);
  }
  if (group == LobeGroup::Rough && !bsdf.hasRough()) {
    EXPECT_EQ(left + sharp, 0) << name;  // its density has no meaning
    return;
  }
  cells.integrate([&](Vec3 w) { return bsdf.pdf(group, w); }, kCount);
  EXPECT_NEAR(cells.sumExpected() / kCount, double(left) / kCount, 0.01) << name;
  EXPECT_LE((cells.sumExpected() + sharp) / kCount, 1.01) << name;
  EXPECT_LT(cells.deviate(), 4.5) << name;
}

// For each sample, value * cosine equals weight * density. A photon that travels from wo to wi is
// scattered like radiance that travels the same way: reciprocity, with refraction and shading
// normals taken into account (Veach 1997, sections 5.2 and 5.3).
void checkSamples(const Scene& scene, Vec3 wo, Vec3 ns, LobeGroup group, const std::string& name) {
  for (const bool insideOut : {false, true}) {
    const SurfacePoint p = seenFrom(wo, ns, insideOut);
    const Bsdf bsdf(scene, p);
    forEachSample(bsdf, group, TransportMode::Radiance, 400, [&](const BsdfSample& s) {
      ASSERT_NEAR(length(s.wi), 1.0f, 1e-4f) << name;
      ASSERT_EQ(s.side, s.wi.z > 0.0f ? p.ng : -p.ng) << name;
      if (s.pdf == 0.0f) return;
      ASSERT_NEAR(s.pdf, bsdf.pdf(group, s.wi), 1e-3f * s.pdf + 1e-5f) << name;
      expectClose(s.weight * s.pdf, bsdf.eval(group, s.wi), 2e-3f, name);
    });
    forEachSample(bsdf, group, TransportMode::Importance, 400, [&](const BsdfSample& s) {
      if (s.pdf == 0.0f || std::fabs(s.wi.z) < 0.15f || dot(s.wi, ns) * s.wi.z < 0.15f) return;
      const SurfacePoint there = seenFrom(s.wi, ns, insideOut);
      const Vec3 radiance = Bsdf(scene, there).eval(group, wo);
      expectClose(s.weight * s.pdf * (wo.z / std::fabs(s.wi.z)), radiance, 5e-3f,
                  name + " adjoint");
    });
  }
}

// The bound holds for cones of directions: it gets the largest cosines of the cone with the axis
// and with the normal.
void checkBound(const Bsdf& bsdf, const std::string& name) {
  const Vec3 ns = bsdf.point().ns, axis = reflect(bsdf.point().wo, ns);
  Rng rng(5, 5);
  for (int i = 0; i < 400; ++i) {
    const float u = rng.next(), v = rng.next(), s = rng.next(), t = rng.next(), near = rng.next();
    const bool around = i % 2 == 0;  // near lobes, where they are highest
    const Vec3 middle = Frame(around ? axis : ns)
                            .toWorld(sampleCone(u, v, around ? 1.0f - 0.3f * near * near : 0.0f));
    const float cosHalf = 1.0f - 0.1f * rng.next(), sinHalf = std::sqrt(1.0f - cosHalf * cosHalf);
    const Vec3 wi = Frame(middle).toWorld(sampleCone(s, t, cosHalf));
    const auto most = [&](Vec3 of) {
      const float c = dot(of, middle);
      return c >= cosHalf ? 1.0f : c * cosHalf + std::sqrt(1.0f - c * c) * sinHalf + 1e-6f;
    };
    const Vec3 bound = bsdf.roughUpperBound(most(ns), most);
    const Vec3 value = bsdf.eval(LobeGroup::Rough, wi);
    for (size_t k = 0; k < 3; ++k)
      ASSERT_LE(value[k], bound[k] * 1.001f + 1e-6f) << name << " " << i;
    ASSERT_LE(maxComponent(bsdf.diffuseValue()) * dot(ns, wi),
              maxComponent(bound) * 1.001f + 1e-6f);
  }
}

// Checks for any material. `tolerance` applies to the furnace and to the stated rough albedo.
void check(const Material& m, const std::string& material, float tolerance) {
  const Scene scene = sceneOf(m);
  for (const Vec3 wo : views()) {
    const std::string name = material + " from z = " + std::to_string(wo.z);
    const SurfacePoint p = seenFrom(wo);
    const Bsdf bsdf(scene, p);
    EXPECT_LE(maxComponent(furnace(m, wo)), 1.0f + tolerance) << name;
    EXPECT_LE(maxComponent(furnace(m, wo, true)), 1.0f + tolerance) << name << " inside";
    EXPECT_LE(bsdf.survivalProbability(), 1.0f) << name;
    EXPECT_NEAR(maxComponent(bsdf.roughAlbedo()), maxComponent(meanWeight(bsdf, LobeGroup::Rough)),
                tolerance)
        << name;
    for (const LobeGroup group : kGroups) {
      checkDensity(bsdf, group, name);
      for (const Vec3 ns : {Vec3{0, 0, 1}, normalize({0.1f, 0.1f, 1})})
        checkSamples(scene, wo, ns, group, name);
    }
    for (const Vec3 ns : {Vec3{0, 0, 1}, normalize({0.5f, 0, 1}), normalize({-0.7f, 0.2f, 1})}) {
      const SurfacePoint tilted = seenFrom(wo, ns);
      checkBound(Bsdf(scene, tilted), name);
      // Energy must not grow where the shading normal is far from the geometric one.
      const Bsdf b(scene, tilted);
      Vec3 sum;
      for (const LobeGroup group : kGroups) {
        // Refraction scales radiance by eta^2, so only what stays on this side is counted.
        double left[3] = {};
        constexpr uint32_t kCount = 1u << 13;
        forEachSample(b, group, TransportMode::Radiance, kCount, [&](const BsdfSample& s) {
          for (size_t c = 0; c < 3; ++c) left[c] += s.wi.z > 0.0f ? double{s.weight[c]} : 0.0;
        });
        sum += Vec3(float(left[0]), float(left[1]), float(left[2])) * (1.0f / kCount);
      }
      EXPECT_LE(maxComponent(sum), 1.0f + 2.0f * tolerance) << name << " tilted";
    }
  }
}

}  // namespace bnvpl::test
