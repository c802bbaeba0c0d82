#include "tools/estimate/report.h"

#include <algorithm>
#include <cstdio>

#include "tools/common/run/result_warning.h"
#include "tools/estimate/lit_columns.h"

namespace bnvpl {

namespace {

float medianError(const VplTable& vpls) {
  std::vector<float> errors;
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (mean(vpls.flux[i]) > 0.0f) errors.push_back(vpls.relativeError[i]);
  }
  if (errors.empty()) return 0.0f;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

// Some VPLs in dark corners are expected to get no light. More than this share causes a warning.
constexpr double kManyDark = 1.0 / 3.0;

// With fewer hits per VPL than this, many VPLs get none even if hits are spread evenly: e^-2 is 14
// %.
constexpr double kFewHits = 2.0;
// Elimination packs disks of the VPLs' radii. Disks that are larger by this factor cover the
// surface.
constexpr double kCovering = 1.1547;  // 2 / sqrt(3)

// Text that says why VPLs are dark, and what to do. `none` means that all VPLs are dark.
std::string causeOfDark(const EstimateResult& result, bool none) {
  if (result.paths > 0 && result.energy.photons > 0)
    return std::string("neither photons nor paths found light there; ") +
           (result.workShare < 1.0 ? "lower --irradiance-error" : "raise --photons") +
           ", or keep fewer VPLs with vpl-eliminate -n";
  if (result.paths > 0)
    return "no path found a light from there; raise --points or --paths, or use --method guarded";
  const EnergyAccount& a = result.energy;
  const auto all = static_cast<double>(result.table.size());
  if (static_cast<double>(a.hits) < kFewHits * all) {
    return "all photons together made " + formatSi(double(a.hits)) + " hits, for " + formatSi(all) +
           " VPLs; raise --photons";
  }
  if (result.table.reachFactor < kCovering) {
    return "they reach so little that most light falls between them; raise --radius (" +
           std::string(kRadiusOption.defaultText) + " unless given)";
  }
  if (a.outside > 0.5 * a.reflected) {
    return "most photons go where the view does not look; raise --photons, try --method paths, or "
           "keep fewer VPLs with vpl-eliminate -n";
  }
  if (none) {
    return "the light does not come to where they are; vpl-inspect scene shows camera and lights, "
           "and raise --photons if it should";
  }
  return "the light gathers at the others; raise --photons, or keep fewer VPLs with vpl-eliminate "
         "-n";
}

void warnOfDark(uint64_t dark, const EstimateResult& result) {
  const auto all = static_cast<double>(result.table.size());
  if (static_cast<double>(dark) <= kManyDark * all) return;
  const bool none = dark == result.table.size();
  char share[32];
  std::snprintf(share, sizeof share, "%.0f %%", 100.0 * static_cast<double>(dark) / all);
  const bool paths = result.paths > 0;
  const std::string which = none ? paths ? "no VPL lights anything: " : "no VPL got a photon: "
                                 : share + std::string(paths ? " of the VPLs light nothing: "
                                                             : " of the VPLs got no photon: ");
  warnOfResult(which + causeOfDark(result, none));
}

void reportPhotons(const EnergyAccount& a, Summary& summary) {
  const auto percent = [](double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
  };
  char line[256];
  std::snprintf(line, sizeof line,
                "%s photons, %s hits: emitted %.4g W, escaped %.1f %%, absorbed %.1f %%",
                formatSi(double(a.photons)).c_str(), formatSi(double(a.hits)).c_str(), a.emitted,
                percent(a.escaped, a.emitted), percent(a.absorbed, a.emitted));
  summary.add("photons", a.photons, line);
  std::snprintf(line, sizeof line,
                "reflected at rough hits %.4g W: deposited %.2f %%, outside the region %.2f %%, "
                "incompatible %.2f %%, hidden %.2f %%",
                a.reflected, percent(a.deposited, a.reflected), percent(a.outside, a.reflected),
                percent(a.incompatible, a.reflected), percent(a.hidden, a.reflected));
  summary.add("hits", a.hits, line);
  summary.add("rays", a.rays);
  summary.add("guard_rays", a.guardRays);
  summary.add("energy_W", {{"emitted", a.emitted},
                           {"escaped", a.escaped},
                           {"absorbed", a.absorbed},
                           {"reflected", a.reflected},
                           {"deposited", a.deposited},
                           {"dropped_outside", a.outside},
                           {"dropped_incompatible", a.incompatible},
                           {"dropped_hidden", a.hidden}});
}

void reportEmission(const UsefulPhotons& useful, Summary& summary) {
  char line[128] = "";
  if (useful.guided > 0.0) {
    std::snprintf(
        line, sizeof line,
        "guided emission: %.3g %% of the photons reach VPLs; by power it would be %.3g %%",
        100.0 * useful.guided, 100.0 * useful.byPower);
  }
  summary.add("useful_photons", {{"by_power", useful.byPower}, {"guided", useful.guided}}, line);
}

void reportWork(double share, Summary& summary) {
  char line[128] = "";
  if (share < 0.995) {
    std::snprintf(line, sizeof line,
                  "%.0f %% of the work of --photons was enough for --irradiance-error",
                  100.0 * share);
  }
  summary.add("work_share", share, line);
}

}  // namespace

void reportShard(const EstimateResult& result, Summary& summary) {
  summary.addNonFinite(result.energy.nonFinite, result.paths > 0 ? "paths" : "photons");
}

void reportEstimate(const EstimateResult& result, Summary& summary) {
  const VplTable& vpls = result.table;
  const bool photons = result.paths == 0;
  if (result.energy.photons > 0) reportPhotons(result.energy, summary);
  if (result.useful.byPower > 0.0) reportEmission(result.useful, summary);
  if (!photons) summary.add("paths", result.paths, formatSi(double(result.paths)) + " paths");
  reportWork(result.workShare, summary);
  if (result.photonsAlone) {
    summary.add("photons_alone", true,
                "no paths: pilots would cost too much for so many VPLs, or found no light; --paths "
                "and --irradiance-error have no effect");
  }
  const auto dark = static_cast<uint64_t>(
      photons ? std::ranges::count(vpls.photons, 0u)
              : std::ranges::count_if(vpls.flux, [](Vec3 f) { return !(mean(f) > 0.0f); }));
  char line[256];
  std::snprintf(line, sizeof line, "median relative error of a VPL %.2g, %llu VPLs without %s",
                double{medianError(vpls)}, static_cast<unsigned long long>(dark),
                photons ? "a photon" : "light");
  summary.add("median_relative_error", medianError(vpls), line);
  summary.add(photons ? "vpls_without_photon" : "vpls_without_light", dark);
  warnOfDark(dark, result);
  summary.addNonFinite(result.energy.nonFinite, photons                     ? "photons"
                                                : result.energy.photons > 0 ? "photons and paths"
                                                                            : "paths");
}

}  // namespace bnvpl
