#include "transport/bsdf/phong/phong.h"

#include <array>
#include <cmath>
#include <numbers>

#include "transport/bsdf.h"
#include "transport/bsdf/between_nodes.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

// Theory.md, eq. 2, relative to wo along the normal. About the mirror direction wi has the polar
// angle a and the azimuth p, and its cosine is cos a cos t + sin a sin t cos p, of which the part
// above the surface is integrated over p. The strata of a are those of cos^(n + 1) a.
double integrateLobe(double cosine, double exponent) {
  constexpr int kSteps = 256;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  double sum = 0.0, alongNormal = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosA = std::pow((i + 0.5) / kSteps, 1.0 / (exponent + 1.0));
    const double along = cosA * cosine, across = std::sqrt(1.0 - cosA * cosA) * sine;
    alongNormal += std::numbers::pi * cosA;
    if (across <= along) {
      sum += std::numbers::pi * along;
      continue;
    }
    // At the azimuth `edge` wi lies in the surface.
    const double edge = std::acos(-along / across);
    sum += edge * along + std::sin(edge) * across;
  }
  return sum / alongNormal;
}

struct PhongTable {
  static constexpr size_t kCosines = 24, kWidths = 16;
  std::array<std::array<float, kCosines>, kWidths> albedo{};
  PhongTable() {
    for (size_t i = 0; i < kWidths; ++i) {
      const double width = std::max(1e-3, double{nodeSquared(i, kWidths)});
      for (size_t j = 0; j < kCosines; ++j)
        albedo[i][j] = static_cast<float>(
            integrateLobe(double{nodeSquared(j, kCosines)}, 1.0 / (width * width) - 1.0));
    }
  }
};

}  // namespace

float phongAlbedo(float cosine, float exponent) {
  static const PhongTable table;
  const float width = 1.0f / std::sqrt(exponent + 1.0f);  // the lobe, in radians
  const BetweenNodes w = betweenSquared<PhongTable::kWidths>(width),
                     c = betweenSquared<PhongTable::kCosines>(cosine);
  const auto inRow = [&](size_t i) {
    const auto& row = table.albedo[i];
    return row[c.node] + (row[c.node + 1] - row[c.node]) * c.share;
  };
  const float low = inRow(w.node);
  return low + (inRow(w.node + 1) - low) * w.share;
}

bool mayBeSpecular(const PhongModel& m) {
  return m.glass || !isBlack(m.mirror) ||
         (!isBlack(m.glossy) && m.exponent > kNearSpecularExponent);
}

std::optional<bool> roughEverywhere(const PhongModel& m) {
  if (mayBeSpecular(m) || m.diffuseMap != kNone || m.glossyMap != kNone) return {};
  return !isBlack(m.diffuse + m.glossy);
}

void addLobes(const PhongModel& m, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  if (m.glass) {
    DielectricModel glass;
    glass.ior = m.ior, glass.reflection = m.mirror, glass.transmission = m.transmission;
    return addLobes(glass, inputs, weight, out);
  }
  Vec3 diffuse = inputs.raw(m.diffuse, m.diffuseMap), glossy = inputs.raw(m.glossy, m.glossyMap),
       mirror = inputs.raw(m.mirror, m.glossyMap);
  const float sum = maxComponent(diffuse + glossy + mirror);
  if (sum > 1.0f) weight *= 1.0f / sum;
  out.add(weight, LambertLobe{diffuse});
  if (!isBlack(glossy)) out.add(weight, PhongLobe{glossy, m.exponent});
  if (isBlack(mirror)) return;
  out.add(weight, GgxReflection{{0.0f, 0.0f}, {FacetFresnel::Kind::Schlick, mirror, mirror}});
}

ModelReport describe(const Scene&, const PhongModel& m) {
  ModelReport out;
  out.model = m.glass ? "glass" : "phong";
  if (m.glass) {
    out.add("ior", Scalar(m.ior));
    out.add("transmission", Colour(m.transmission));
    out.add("mirror", Colour(m.mirror));
    return out;
  }
  out.add("diffuse", ModelReport::Image{m.diffuse, m.diffuseMap});
  if (!isBlack(m.glossy) || m.glossyMap != kNone) {
    out.add("glossy", ModelReport::Image{m.glossy, m.glossyMap});
    out.add("exponent", Scalar(m.exponent));
  }
  if (!isBlack(m.mirror)) out.add("mirror", Colour(m.mirror));
  return out;
}

MtlModel toMtl(const Scene&, const PhongModel& m) { return {m, {}, true}; }

}  // namespace bnvpl
