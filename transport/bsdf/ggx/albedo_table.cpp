#include "transport/bsdf/ggx/albedo_table.h"

#include <array>
#include <vector>

#include "transport/bsdf/between_nodes.h"
#include "transport/bsdf/fresnel.h"
#include "transport/bsdf/ggx/ggx.h"

namespace bnvpl {

namespace {

// Nodes are denser where cosine and alpha are small.
constexpr size_t kCosines = 24, kAlphas = 28, kIors = 13;
constexpr float kMinCosine = 1e-4f;
BetweenNodes ofCosine(float c) { return betweenSquared<kCosines>(c); }
BetweenNodes ofAlpha(float a) { return betweenSquared<kAlphas>(a); }
BetweenNodes ofIor(float ior) {
  return betweenSquared<kIors>((ior - 1.0f) / (kMaxAlbedoIor - 1.0f));
}

// Calls fn(cosine at the facet, weight). Weights sum to the albedo of facets that reflect all
// light. Normals on one side of the plane of incidence suffice, by symmetry.
template <typename Fn>
void overVisibleFacets(float cosine, float alpha, const Fn& fn) {
  constexpr uint32_t kPoints = 512;
  const float co = std::max(kMinCosine, cosine);
  const Vec3 wo{std::sqrt(1.0f - co * co), 0.0f, co};
  const Ggx ggx{std::max(kSmoothAlpha, alpha), std::max(kSmoothAlpha, alpha)};
  for (uint32_t i = 0; i < kPoints; ++i) {
    const Point2 at = r2Sequence(i, 0.5, 0.5);
    const Vec3 h = ggx.sampleVisible(wo, {0.5f * at.x, at.y});
    const Vec3 wi = reflect(wo, h);
    if (!(wi.z > 0.0f)) continue;
    fn(std::min(1.0f, dot(wo, h)), ggx.visible(wo, wi) / (ggx.visible(wo) * kPoints));
  }
}

// Cosine-weighted mean of a function that is linear between the nodes of cosine.
template <typename Fn>
float hemisphereMean(const Fn& fn) {
  constexpr int kSteps = 512;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    sum += 2.0 * c * double{fn(static_cast<float>(c))} / kSteps;
  }
  return static_cast<float>(sum);
}

// The coefficients of f0, f90 and -a in the albedo.
struct Parts {
  float f0 = 0.0f, f90 = 0.0f, a = 0.0f;
};
Parts mixed(const Parts& p, const Parts& q, float share) {
  const auto mix = [&](float x, float y) { return x + (y - x) * share; };
  return {mix(p.f0, q.f0), mix(p.f90, q.f90), mix(p.a, q.a)};
}

struct SchlickTable {
  std::array<std::array<Parts, kCosines>, kAlphas> parts{};
  std::array<float, kAlphas> meanLoss{}, largestLoss{};
  SchlickTable() {
    for (size_t i = 0; i < kAlphas; ++i) {
      const float alpha = nodeSquared(i, kAlphas);
      for (size_t j = 0; j < kCosines; ++j) {
        Parts& p = parts[i][j];
        overVisibleFacets(nodeSquared(j, kCosines), alpha, [&](float c, float weight) {
          const float m5 = schlickWeight(c);
          p.f0 += weight * (1.0f - m5);
          p.f90 += weight * m5;
          p.a += weight * c * m5 * (1.0f - c);
        });
        largestLoss[i] = std::max(largestLoss[i], 1.0f - p.f0 - p.f90);
      }
      meanLoss[i] = hemisphereMean([&](float c) {
        const Parts p = row(i, c);
        return std::max(0.0f, 1.0f - p.f0 - p.f90);
      });
    }
  }
  Parts row(size_t alpha, float cosine) const {
    const BetweenNodes c = ofCosine(cosine);
    return mixed(parts[alpha][c.node], parts[alpha][c.node + 1], c.share);
  }
  Parts at(float cosine, float alpha) const {
    const BetweenNodes a = ofAlpha(alpha);
    return mixed(row(a.node, cosine), row(a.node + 1, cosine), a.share);
  }
  static const SchlickTable& get() {
    static const SchlickTable table;
    return table;
  }
};

float between(const std::array<float, kAlphas>& values, float alpha) {
  const BetweenNodes a = ofAlpha(alpha);
  return values[a.node] + (values[a.node + 1] - values[a.node]) * a.share;
}

struct DielectricTable {
  using Row = std::array<float, kCosines>;
  std::array<std::array<Row, kAlphas>, kIors> albedo{};
  std::array<std::array<float, kAlphas>, kIors> mean{};
  DielectricTable() {
    std::array<float, kIors> iors;
    for (size_t k = 0; k < kIors; ++k)
      iors[k] = 1.0f + (kMaxAlbedoIor - 1.0f) * nodeSquared(k, kIors);
    for (size_t i = 0; i < kAlphas; ++i) {
      const float alpha = nodeSquared(i, kAlphas);
      for (size_t j = 0; j < kCosines; ++j) {
        overVisibleFacets(nodeSquared(j, kCosines), alpha, [&](float c, float weight) {
          for (size_t k = 0; k < kIors; ++k)
            albedo[k][i][j] += weight * fresnelDielectric(c, iors[k]);
        });
      }
      for (size_t k = 0; k < kIors; ++k) {
        mean[k][i] = hemisphereMean([&](float c) {
          return alpha < kSmoothAlpha ? fresnelDielectric(c, iors[k]) : inRow(albedo[k][i], c);
        });
      }
    }
  }
  static float inRow(const Row& row, float cosine) {
    const BetweenNodes c = ofCosine(cosine);
    return row[c.node] + (row[c.node + 1] - row[c.node]) * c.share;
  }
  static const DielectricTable& get() {
    static const DielectricTable table;
    return table;
  }
};

// Bilinear interpolation of fn(node of ior, node of alpha).
template <typename Fn>
float overIorAndAlpha(float ior, float alpha, const Fn& fn) {
  const BetweenNodes k = ofIor(ior), a = ofAlpha(alpha);
  const auto row = [&](size_t node) {
    const float low = fn(node, a.node);
    return low + (fn(node, a.node + 1) - low) * a.share;
  };
  const float low = row(k.node);
  return low + (row(k.node + 1) - low) * k.share;
}

}  // namespace

Vec3 SchlickFresnel::at(float cosine) const {
  const float m5 = schlickWeight(cosine);
  return f0 + (f90 - f0) * m5 - a * (cosine * (1.0f - cosine) * m5);
}

Vec3 SchlickFresnel::mean() const { return f0 + (f90 - f0) * (1.0f / 21.0f) - a * (1.0f / 126.0f); }

SchlickFresnel schlickOf(Vec3 eta, Vec3 k) {
  constexpr float kCosine = 1.0f / 7.0f;
  SchlickFresnel s;
  s.f0 = fresnelConductor(1.0f, eta, k);
  const float perA = kCosine * (1.0f - kCosine) * schlickWeight(kCosine);
  s.a = (s.at(kCosine) - fresnelConductor(kCosine, eta, k)) * (1.0f / perA);
  return s;
}

Vec3 ggxAlbedo(const SchlickFresnel& fresnel, float cosine, float alpha) {
  const Parts p = SchlickTable::get().at(cosine, alpha);
  return max(Vec3(), min(Vec3(1), fresnel.f0 * p.f0 + fresnel.f90 * p.f90 - fresnel.a * p.a));
}

float ggxAlbedo(float f0, float f90, float cosine, float alpha) {
  const Parts p = SchlickTable::get().at(cosine, alpha);
  return std::clamp(f0 * p.f0 + f90 * p.f90, 0.0f, 1.0f);
}

float ggxLoss(float cosine, float alpha) {
  const Parts p = SchlickTable::get().at(cosine, alpha);
  return std::clamp(1.0f - p.f0 - p.f90, 0.0f, 1.0f);
}
float ggxMeanLoss(float alpha) { return between(SchlickTable::get().meanLoss, alpha); }
float ggxLargestLoss(float alpha) { return between(SchlickTable::get().largestLoss, alpha); }

float dielectricAlbedo(float cosine, float alpha, float ior) {
  if (alpha < kSmoothAlpha) return fresnelDielectric(std::min(1.0f, cosine), ior);
  const DielectricTable& table = DielectricTable::get();
  return overIorAndAlpha(ior, alpha, [&](size_t k, size_t a) {
    return DielectricTable::inRow(table.albedo[k][a], cosine);
  });
}
float dielectricMeanAlbedo(float alpha, float ior) {
  const DielectricTable& table = DielectricTable::get();
  return overIorAndAlpha(ior, alpha < kSmoothAlpha ? 0.0f : alpha,
                         [&](size_t k, size_t a) { return table.mean[k][a]; });
}

float schlickOverHemisphere(float cosine) {
  static const std::array<float, kCosines> table = [] {
    std::array<float, kCosines> t{};
    constexpr int kSide = 48;
    for (size_t j = 0; j < kCosines; ++j) {
      const float co = std::max(kMinCosine, nodeSquared(j, kCosines));
      const Vec3 wo{std::sqrt(1.0f - co * co), 0.0f, co};
      for (int i = 0; i < kSide * kSide; ++i) {
        const Vec3 wi = sampleCosineHemisphere((float(i % kSide) + 0.5f) / kSide,
                                               (float(i / kSide) + 0.5f) / kSide);
        t[j] += schlickWeight(dot(wo, normalize(wo + wi))) / (kSide * kSide);
      }
    }
    return t;
  }();
  const BetweenNodes c = ofCosine(cosine);
  return table[c.node] + (table[c.node + 1] - table[c.node]) * c.share;
}

}  // namespace bnvpl
