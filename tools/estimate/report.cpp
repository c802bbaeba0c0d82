#include "tools/estimate/report.h"

#include <algorithm>
#include <cstdio>

namespace bnvpl {

namespace {

float medianError(const VplTable& vpls) {
  std::vector<float> errors;
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (vpls.photons[i] > 0) errors.push_back(vpls.relativeError[i]);
  }
  if (errors.empty()) return 0.0f;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

// Some VPLs in dark corners are to be expected; more than this share says that photons go
// elsewhere.
constexpr double kManyDark = 0.5;

void warnOfDark(uint64_t dark, size_t vpls) {
  if (static_cast<double>(dark) <= kManyDark * static_cast<double>(vpls)) return;
  char line[256];
  std::snprintf(line, sizeof line,
                "%.0f %% of the VPLs got no photon and light nothing: most photons go where the "
                "view does not look; raise --photons, or keep fewer VPLs with vpl-eliminate -n",
                100.0 * static_cast<double>(dark) / static_cast<double>(vpls));
  printWarnings("vpl-estimate", {line});
}

}  // namespace

void reportEstimate(const EstimateResult& result, Summary& summary) {
  const EnergyAccount& a = result.energy;
  const VplTable& vpls = result.table;
  const auto percent = [](double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
  };
  char line[256];
  std::snprintf(line, sizeof line,
                "%s photons, %s hits: emitted %.4g W, escaped %.1f %%, absorbed %.1f %%",
                formatSi(double(a.photons)).c_str(), formatSi(double(a.hits)).c_str(), a.emitted,
                percent(a.escaped, a.emitted), percent(a.absorbed, a.emitted));
  summary.add("photons", a.photons, line);
  std::snprintf(
      line, sizeof line,
      "reflected at diffuse hits %.4g W: deposited %.2f %%, outside the region %.2f %%, in a gap "
      "%.2f %%, hidden %.2f %%",
      a.reflected, percent(a.deposited, a.reflected), percent(a.outside, a.reflected),
      percent(a.gap, a.reflected), percent(a.hidden, a.reflected));
  summary.add("hits", a.hits, line);
  const auto dark = static_cast<uint64_t>(std::count(vpls.photons.begin(), vpls.photons.end(), 0u));
  std::snprintf(line, sizeof line,
                "median relative error of a VPL %.2g, %llu VPLs without a photon",
                double{medianError(vpls)}, static_cast<unsigned long long>(dark));
  summary.add("median_relative_error", medianError(vpls), line);
  summary.add("vpls_without_photon", dark);
  warnOfDark(dark, vpls.size());
  summary.add("rays", a.rays);
  summary.add("guard_rays", a.guardRays);
  summary.addNonFinite(a.nonFinite, "photons");
  summary.add("energy_W", {{"emitted", a.emitted},
                           {"escaped", a.escaped},
                           {"absorbed", a.absorbed},
                           {"reflected", a.reflected},
                           {"deposited", a.deposited},
                           {"dropped_outside", a.outside},
                           {"dropped_gap", a.gap},
                           {"dropped_hidden", a.hidden}});
}

}  // namespace bnvpl
