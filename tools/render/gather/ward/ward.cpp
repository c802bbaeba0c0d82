// Adaptive shadow testing (Ward 1994): at each point the VPLs are sorted by their unoccluded
// contribution and shadow-tested in that order until the rest is below a tolerance. The rest is
// weighted by its expected visibility.
#include <algorithm>
#include <array>
#include <memory>

#include "core/parallel.h"
#include "tools/render/gather/gather.h"
#include "tools/render/gather/rgb_sum.h"

namespace bnvpl::methods::gather::ward {

namespace {

constexpr auto kToleranceOption =
    realOption("tolerance", "0.1", 0, 1, "share of the light so far",
               "shadow tests end when the untested VPLs contribute no more than this");
constexpr auto kVisibilityTestsOption =
    countOption("visibility-tests", "32", 65536, "rays",
                "rays to each VPL from visible points, for its mean visibility");
constexpr auto kOptions = optionTable(kToleranceOption, kVisibilityTestsOption);

// Visibility of each VPL, averaged over visible points that it faces. Ward counts while rendering,
// which would depend on the order of pixels and threads. Here the counts are taken beforehand, from
// the same points for all VPLs. One additional hit and one miss keep the rate away from 0 and 1,
// which few tests cannot establish.
std::vector<float> hitRates(const GatherInputs& in, uint64_t tests) {
  std::vector<SurfacePoint> seen;
  for (const SurfacePoint& p : in.filmPoints().points) {
    if (p.triangle != kNone) seen.push_back(p);
  }
  std::vector<float> rates(in.vpls.size(), 0.5f);
  if (seen.empty()) return rates;
  const auto phase = in.progress.beginPhase("visibility pilot, VPLs", rates.size());
  parallelFor(rates.size(), 16, [&](size_t i) {
    uint32_t faced = 0, hits = 0;
    for (uint64_t k = 0; k < tests; ++k) {
      const SurfacePoint& p = seen[k * seen.size() / tests];
      VplTransfer c;
      if (!unoccludedTransfer(in.vpls, i, Bsdf(in.accel.scene(), p), c)) continue;
      ++faced;
      hits +=
          in.accel.occluded(in.accel.offsetOrigin(p.position, p.ng), in.vpls.position[i]) ? 0 : 1;
    }
    rates[i] = (static_cast<float>(hits) + 1.0f) / (static_cast<float>(faced) + 2.0f);
    if (in.progress) in.progress(1);
  });
  return rates;
}

struct Potential {
  float sum;  // unoccluded contribution, summed over the channels
  uint32_t vpl;
  Vec3 light, transfer;
  float clampLoss;
  bool sampled;
};
bool brighter(const Potential& a, const Potential& b) {
  return a.sum != b.sum ? a.sum > b.sum : a.vpl < b.vpl;
}

std::vector<Potential>& sortedPotentials(const VplLights& vpls, const Bsdf& bsdf) {
  thread_local std::vector<Potential> list;  // reused between calls to avoid allocations
  list.clear();
  VplTransfer c;
  for (uint32_t i = 0; i < vpls.size(); ++i) {
    if (!unoccludedTransfer(vpls, i, bsdf, c)) continue;
    const Vec3 light = c.transfer * vpls.intensity[i];
    list.push_back({light.x + light.y + light.z, i, light, c.transfer, c.clampLoss, c.sampled});
  }
  std::ranges::sort(list, brighter);
  return list;
}

Gathered gatherPoint(const Accelerator& accel, const VplLights& vpls,
                     const std::vector<float>& rates, double tolerance, const Bsdf& bsdf,
                     const LightGroupSink& groups) {
  const std::vector<Potential>& list = sortedPotentials(vpls, bsdf);
  double untested = 0.0;
  Gathered out;
  for (const Potential& p : list) {
    untested += double{p.sum};
    out.sampledPairs += p.sampled;
  }
  const Vec3 from = accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  RgbSum total, clamped;
  const auto add = [&](const Potential& p, double share) {
    total.add(p.light, share);
    clamped.add(p.light * p.clampLoss, share);
    if (groups) vpls.addByGroup(p.vpl, p.transfer * static_cast<float>(share), groups);
  };
  // Number of visible VPLs among those tested, and its expectation from their mean visibility. The
  // ratio is the openness of this point.
  double hits = 0.0, expected = 0.0;
  size_t tested = 0;
  for (; tested < list.size() && untested > tolerance * total.sum(); ++tested) {
    const Potential& p = list[tested];
    ++out.shadowRays;
    expected += double{rates[p.vpl]};
    untested -= double{p.sum};
    if (accel.occluded(from, vpls.position[p.vpl])) continue;
    hits += 1.0;
    add(p, 1.0);
  }
  const double openness = expected > 0.0 ? hits / expected : 1.0;
  for (size_t k = tested; k < list.size(); ++k) {
    add(list[k], std::min(1.0, openness * double{rates[list[k].vpl]}));
  }
  out.cut = static_cast<uint32_t>(tested);
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto rates =
      std::make_shared<const std::vector<float>>(hitRates(in, options[kVisibilityTestsOption]));
  return gatherEach(
      [&accel = in.accel, &vpls = in.vpls, rates, tolerance = options[kToleranceOption]](
          const Bsdf& bsdf, const LightGroupSink& groups) {
        return gatherPoint(accel, vpls, *rates, tolerance, bsdf, groups);
      });
}

}  // namespace

extern const GatherMethod method{
    .name = "ward",
    .summary = "VPLs sorted by contribution, shadow-tested until the rest is negligible",
    .options = kOptions,
    .make = make};

}  // namespace bnvpl::methods::gather::ward
