#include "transport/bsdf/metallic_roughness/layered_albedo.h"

#include <array>

#include "transport/bsdf/between_nodes.h"
#include "transport/bsdf/metallic_roughness/metallic_roughness.h"

namespace bnvpl {

namespace {

constexpr size_t kCosines = 18, kF0s = 6, kF90s = 4, kAlphas = 16;
constexpr int kPolar = 12, kAzimuths = 12;  // quadrature over half the hemisphere, by symmetry

using OverCosine = std::array<float, kCosines>;

struct Table {
  std::array<std::array<std::array<OverCosine, kAlphas>, kF90s>, kF0s> albedo{};
  Table() {
    for (size_t f = 0; f < kF0s; ++f)
      for (size_t g = 0; g < kF90s; ++g)
        for (size_t a = 0; a < kAlphas; ++a)
          albedo[f][g][a] =
              row({Vec3(1), nodeSquared(f, kF0s), nodeSquared(g, kF90s), nodeSquared(a, kAlphas)});
  }
  // Midpoints of strata of equal weight: cosine-weighted directions have uniform cos^2.
  static OverCosine row(const LayeredBase& base) {
    std::array<float, kPolar> cosines, keptBy;
    for (size_t i = 0; i < kPolar; ++i) {
      cosines[i] = std::sqrt((float(i) + 0.5f) / kPolar);
      keptBy[i] = base.kept(cosines[i]);
    }
    OverCosine out{};
    for (size_t j = 0; j < kCosines; ++j) {
      const float co = std::max(1e-4f, nodeSquared(j, kCosines)), keptOut = base.kept(co);
      const Vec3 wo{std::sqrt(1.0f - co * co), 0.0f, co};
      for (size_t i = 0; i < kPolar; ++i) {
        const float sine = std::sqrt(1.0f - cosines[i] * cosines[i]);
        for (int k = 0; k < kAzimuths; ++k) {
          const float phi = kPi * (float(k) + 0.5f) / kAzimuths;
          const Vec3 wi{sine * std::cos(phi), sine * std::sin(phi), cosines[i]};
          out[j] += (1.0f - base.layer(dot(wo, normalize(wo + wi)))) * std::min(keptOut, keptBy[i]);
        }
      }
      out[j] /= kPolar * kAzimuths;
    }
    return out;
  }
};

}  // namespace

float layeredAlbedo(float cosine, float f0, float f90, float alpha) {
  static const Table table;
  const BetweenNodes f = betweenSquared<kF0s>(f0), g = betweenSquared<kF90s>(f90),
                     a = betweenSquared<kAlphas>(alpha), c = betweenSquared<kCosines>(cosine);
  float sum = 0.0f;
  for (size_t corner = 0; corner < 16; ++corner) {
    const auto up = [&](size_t bit) { return (corner >> bit) & 1; };
    const auto share = [&](const BetweenNodes& b, size_t bit) {
      return up(bit) ? b.share : 1.0f - b.share;
    };
    const float weight = share(f, 0) * share(g, 1) * share(a, 2) * share(c, 3);
    sum += weight * table.albedo[f.node + up(0)][g.node + up(1)][a.node + up(2)][c.node + up(3)];
  }
  return sum;
}

}  // namespace bnvpl
