#include "tools/render/tile/control/irradiance_field.h"

#include <cmath>
#include <span>

#include "core/parallel.h"
#include "core/sampling.h"
#include "spatial/near_surfaces.h"
#include "spatial/packed_disks.h"

namespace bnvpl {

namespace {

constexpr float kMinAlbedo = 0.01f;  // the irradiance at darker VPLs would be noise
constexpr float kSmooth = 5.0f;      // radius of the average, in radii of the VPL

}  // namespace

IrradianceField::IrradianceField(const VplTable& lit, const VplGroups& groups)
    : regions_(lit.position, lit.normal, lit.radius),
      indirect_(lit.size()),
      groups_(groups.groups),
      byGroup_(groups.flux.size()) {
  const NearSurfaces near(lit.position, lit.normal, lit.radius, kSmooth);
  parallelFor(lit.size(), 64, [&](size_t i) {
    Vec3 flux, reflected;
    const auto own = std::span(byGroup_).subspan(i * groups_, groups_);
    near.forEach(i, [&](uint32_t k) {
      const float area = packedDiskArea(lit.radius[k]);
      flux += lit.flux[k] - lit.firstBounceFlux[k];
      for (uint32_t g = 0; g < groups_; ++g) {
        const size_t at = size_t{k} * groups_ + g;
        own[g] += groups.flux[at] - groups.firstBounceFlux[at];
      }
      reflected += max(lit.albedo[k], Vec3(kMinAlbedo)) * area;
    });
    for (size_t c = 0; c < 3; ++c) indirect_[i][c] = std::max(0.0f, flux[c]) / (kPi * reflected[c]);
    for (Vec3& light : own)
      light = {light.x / (kPi * reflected.x), light.y / (kPi * reflected.y),
               light.z / (kPi * reflected.z)};
  });
}

}  // namespace bnvpl
