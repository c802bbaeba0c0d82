#include "tools/inspect/doctor/doctor.h"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/files.h"
#include "scene/surface_area.h"
#include "spatial/packed_disks.h"
#include "tools/common/run/progress_meter.h"
#include "tools/common/run/run_tool.h"
#include "tools/inspect/doctor/light_trials.h"
#include "tools/inspect/doctor/surface_trial.h"

namespace bnvpl {
namespace {

constexpr uint64_t kPhotonsOfLight = 2048, kPhotonsOfAll = 1 << 20;
constexpr size_t kLightsShown = 20, kFilesShown = 10;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}
std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100.0 * share);
  return text;
}

class Findings {
 public:
  void add(bool found, const std::string& what, const std::string& change) {
    if (found) list_.push_back({{"what", what}, {"change", change}});
  }
  Json list() const { return list_; }

 private:
  Json list_ = Json::array();
};

Json trialOf(const Accelerator& accel, const LightSet& lights, size_t light, uint64_t photons,
             Findings& findings) {
  const LightTrial t = tryLight(accel, lights, light, photons);
  const std::string name = lights.name(light);
  const bool local = lights.extent(light).local;
  findings.add(local && t.meetsAtOnce > 0.9,
               name + " shines into a surface right before it: " + percent(t.meetsAtOnce) +
                   " of its photons end within " + percent(kAtOnce) + " of the scene's size",
               "turn it round, or move it off that surface; of an emissive mesh, flip the winding, "
               "or let it shine from both sides");
  findings.add(
      local && t.leaves > 0.9,
      name + " shines out of the scene: " + percent(t.leaves) + " of its photons hit nothing",
      "turn it towards what it is to light");
  const Vec3 power = lights.power(light);
  return {{"light", name},
          {"power_W", {power.x, power.y, power.z}},
          {"shines", directionText(t.direction)},
          {"meets_at_once", t.meetsAtOnce},
          {"leaves", t.leaves},
          {"reaches_view", t.reachesView}};
}

// All lights, or the strongest where there are many. Returns the share of the tried power that
// reaches the view.
double describeLights(const Accelerator& accel, const LightSet& lights, Json& json,
                      Findings& findings) {
  std::vector<size_t> order(lights.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(
      order, [&](size_t a, size_t b) { return mean(lights.power(a)) > mean(lights.power(b)); });
  const size_t shown = std::min(order.size(), size_t{1024});
  const uint64_t photons =
      std::min<uint64_t>(kPhotonsOfLight, kPhotonsOfAll / std::max<size_t>(1, shown));
  double power = 0.0, seen = 0.0;
  json["lights"] = Json::array();
  for (size_t i = 0; i < shown; ++i) {
    if (!(mean(lights.power(order[i])) > 0.0f)) continue;
    json["lights"].push_back(trialOf(accel, lights, order[i], photons, findings));
    power += double{mean(lights.power(order[i]))};
    seen +=
        json["lights"].back()["reaches_view"].get<double>() * double{mean(lights.power(order[i]))};
  }
  const double share = power > 0.0 ? seen / power : 0.0;
  findings.add(power == 0.0, "no light has power, so that images are black",
               "add a [[light]] or an emissive material, or give the scene file as a [[mesh]] of a "
               "scene.toml that has lights");
  findings.add(power > 0.0 && share < 0.001,
               percent(share) + " of the light reaches what the camera sees, over eight bounces",
               "look whether a wall shuts the lights off, or let them shine into the view; if it "
               "is meant so, keep --emission guided");
  return share;
}

void describeView(const Accelerator& accel, Json& json, Findings& findings) {
  const ViewTrial v = tryView(accel);
  json["view"] = {{"depth", v.depth}, {"open", v.open}, {"closed", v.closed}, {"behind", v.behind}};
  findings.add(v.open > 0.999, "the camera sees no surface",
               "turn it towards the scene: vpl-inspect scene shows its place and the bounds");
  findings.add(v.closed > 0.5 && v.behind > 0.95 * v.closed,
               "the camera sees backs of surfaces in " + percent(v.behind) +
                   " of the directions around it: it is inside a solid",
               "move it out; if this is a room whose walls are wound outwards, nothing is wrong");
  findings.add(v.touching > 0.5, "something stands right before the camera",
               "move the camera, or what covers the film");
  const bool room = v.closed > 0.95 && v.open < 0.05;
  findings.add(room && v.depth > 30.0,
               "a room whose walls are " + number(v.depth) + " m away: its unit may be cm or mm",
               "scale the scene to metres, by 0.01 or 0.001; light falls off with the square of "
               "distance");
  findings.add(
      room && v.depth > 0.0 && v.depth < 0.1,
      "a room whose walls are " + number(v.depth) + " m away: its unit may be larger than m",
      "scale the scene to metres");
}

void describeVpls(const Accelerator& accel, Json& json, Findings& findings) {
  const double area = surfaceArea(accel.scene()), used = shareInUse(accel),
               depth = json["view"]["depth"].get<double>();
  const double radius = packedDiskRadius(used * area, kUsualVpls);
  json["vpls"] = {
      {"surface", area}, {"in_use", used}, {"count", kUsualVpls}, {"spacing", 2.0 * radius}};
  constexpr double kWide = 0.2;  // spacing over depth above which each VPL is seen
  const double enough = kUsualVpls * std::pow(2.0 * radius / (kWide * std::max(depth, 1e-30)), 2.0);
  findings.add(depth > 0.0 && 2.0 * radius > kWide * depth && enough < 1e8,
               formatSi(kUsualVpls) + " VPLs on the surfaces that light the view would stand " +
                   number(2.0 * radius) + " m apart, in a view that is " + number(depth) +
                   " m deep",
               "place and keep more: -n " + number(std::ceil(enough / 1000.0)) +
                   "k of vpl-eliminate, and some 20 times as many of vpl-place");
}

void describeCost(const Accelerator& accel, Json& json) {
  const Scene& scene = accel.scene();
  const double pixels = double{1} * scene.film.width * scene.film.height,
               samples = pixels * kUsualSpp,
               triangles = std::max(2.0, static_cast<double>(scene.triangles.size()));
  const double cpuS =
      kUsualPhotons * kSecondsPerPhoton +
      samples * (kSecondsPerSample + kSecondsPerSampleLog2Vpls * std::log2(kUsualVpls) +
                 kSecondsPerSampleLog2Triangles * std::log2(triangles));
  constexpr double kBytesPerPixel = 300.0, kBytesPerTriangle = 190.0, kBytesPerVpl = 4000.0;
  const double bytes = 64e6 + pixels * kBytesPerPixel + kUsualVpls * kBytesPerVpl +
                       static_cast<double>(scene.triangles.size()) * kBytesPerTriangle;
  json["cost"] = {{"cpu_s", cpuS}, {"memory_MiB", bytes / 1048576.0}};
}

// Warnings of files that are missing become one finding.
void describeWarnings(const Scene& scene, Json& json, Findings& findings) {
  std::vector<std::string> missing;
  for (const fs::path& file : scene.files) {
    if (!isRegularFile(file)) missing.push_back(file.string());
  }
  json["missing"] = missing;
  const auto isOfMissing = [&](const std::string& warning) {
    return std::ranges::any_of(missing, [&](const std::string& file) {
      return warning.find(file + ": ") != warning.npos;
    });
  };
  std::string names;
  for (size_t i = 0; i < missing.size() && i < kFilesShown; ++i)
    names += (i > 0 ? ", " : "") + missing[i];
  if (missing.size() > kFilesShown)
    names += " and " + std::to_string(missing.size() - kFilesShown) + " more";
  findings.add(!missing.empty(), "textures or other files are missing: " + names,
               "put them there, or correct their names in the file that names them, relative to "
               "its folder; a .glb holds its textures");
  for (const std::string& warning : scene.warnings) {
    findings.add(!isOfMissing(warning), warning,
                 "see what the message says; what is ignored may be missed");
  }
}

}  // namespace

Json diagnose(const Accelerator& accel, const LightSet& lights) {
  const Scene& scene = accel.scene();
  Json json{{"scene", scene.name()}};
  Findings findings;
  json["reaches_view"] = describeLights(accel, lights, json, findings);
  describeView(accel, json, findings);
  describeVpls(accel, json, findings);
  describeCost(accel, json);
  describeWarnings(scene, json, findings);
  json["findings"] = findings.list();
  return json;
}

std::string doctorText(const Json& asFound) {
  const Json d = withEscapedNames(asFound);
  std::ostringstream out;
  const auto real = [](const Json& value) { return value.get<double>(); };
  out << d["scene"].get<std::string>() << "\n";
  size_t shown = 0;
  for (const Json& l : d["lights"]) {
    if (++shown > kLightsShown) break;
    out << "  " << l["light"].get<std::string>() << ": (" << number(real(l["power_W"][0])) << " "
        << number(real(l["power_W"][1])) << " " << number(real(l["power_W"][2])) << ") W, shines "
        << l["shines"].get<std::string>() << "; " << percent(real(l["reaches_view"]))
        << " reaches the view, " << percent(real(l["leaves"])) << " leaves the scene\n";
  }
  if (d["lights"].size() > kLightsShown)
    out << "  and " << d["lights"].size() - kLightsShown << " weaker lights\n";
  out << "  view: surfaces " << number(real(d["view"]["depth"])) << " m away, "
      << percent(real(d["view"]["open"])) << " of the film shows none; "
      << percent(real(d["reaches_view"])) << " of the light reaches it\n"
      << "  VPLs: " << formatSi(real(d["vpls"]["count"])) << " on the "
      << percent(real(d["vpls"]["in_use"])) << " of the surface that lights the view are "
      << number(real(d["vpls"]["spacing"])) << " m apart\n"
      << "  with the defaults: about " << durationText(real(d["cost"]["cpu_s"]))
      << " of CPU time and " << number(real(d["cost"]["memory_MiB"]))
      << " MiB; --estimate of each stage measures them\n";
  if (d["findings"].empty()) out << "nothing to change\n";
  size_t n = 0;
  for (const Json& f : d["findings"]) {
    out << ++n << ". " << f["what"].get<std::string>() << "\n   -> "
        << f["change"].get<std::string>() << "\n";
  }
  return out.str();
}

}  // namespace bnvpl
