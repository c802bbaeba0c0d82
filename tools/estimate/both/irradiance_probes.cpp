#include "tools/estimate/both/irradiance_probes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/sampling.h"
#include "spatial/packed_disks.h"

namespace bnvpl::methods::estimate::both {

namespace {

constexpr size_t kRays = size_t{1} << 20, kMin = 16, kMax = 256;

size_t countFor(size_t vpls) {
  return std::min(vpls, std::clamp(kRays / std::max<size_t>(1, vpls), kMin, kMax));
}

// Irradiance at VPL `at` per watt of VPL `from`. The flux is spread over a disk with the area of
// the VPL's share of the surface, whose form factor is approximated by area cos cos / (pi d^2 +
// area).
float irradiancePerWatt(const VplTable& vpls, size_t at, size_t from) {
  const Vec3 d = vpls.position[from] - vpls.position[at];
  const float d2 = lengthSquared(d);
  const float received = dot(d, vpls.normal[at]), sent = -dot(d, vpls.normal[from]);
  if (!(received > 0.0f && sent > 0.0f)) return 0.0f;
  const float area = packedDiskArea(vpls.radius[from]);
  return received * sent / (d2 * (kPi * d2 + area));
}

}  // namespace

IrradianceProbes::IrradianceProbes(const VplTable& vpls, const Accelerator& accel)
    : vpls_(vpls.size()), weights_(countFor(vpls.size()) * vpls.size()) {
  const size_t count = countFor(vpls_);
  parallelFor(count, 1, [&](size_t r) {
    const size_t at = r * vpls_ / count;
    const Vec3 from = accel.offsetOrigin(vpls.position[at], vpls.normal[at]);
    for (size_t i = 0; i < vpls_; ++i) {
      const float weight = irradiancePerWatt(vpls, at, i);
      if (!(weight > 0.0f)) continue;
      const Vec3 to = accel.offsetOrigin(vpls.position[i], vpls.normal[i]);
      if (!accel.occluded(from, to)) weights_[r * vpls_ + i] = weight;
    }
  });
}

double IrradianceProbes::relativeError(std::span<const double> flux,
                                       std::span<const double> variance) const {
  double sum = 0.0;
  size_t lit = 0;
  for (auto w = weights_.begin(); w != weights_.end(); w += static_cast<std::ptrdiff_t>(vpls_)) {
    double irradiance = 0.0, squared = 0.0;
    for (size_t i = 0; i < vpls_; ++i) {
      const auto weight = double{w[static_cast<std::ptrdiff_t>(i)]};
      irradiance += weight * flux[i];
      squared += weight * weight * variance[i];
    }
    if (!(squared > 0.0)) continue;
    ++lit;
    sum += irradiance > 0.0 ? std::min(1.0, std::sqrt(squared) / irradiance) : 1.0;
  }
  return lit > 0 ? sum / static_cast<double>(lit) : 1.0;  // unknown
}

}  // namespace bnvpl::methods::estimate::both
