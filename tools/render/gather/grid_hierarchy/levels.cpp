#include "tools/render/gather/grid_hierarchy/levels.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"

namespace bnvpl::methods::gather::grid_hierarchy {

namespace {

// A grid pays where it has at most this share of lights per VPL (Yuksel & Yuksel 2017).
constexpr double kMaxLightsPerVpl = 0.25;
// Cells of the finest grid that is tried, along the diagonal.
constexpr int kFinestExponent = 12;

// The part of a VPL that a light of a grid stands for. Lights are told apart by their node of the
// grid and the octant of their normals.
struct Part {
  uint64_t light;
  uint32_t vpl;
  float weight;
};

std::vector<Part> partsOf(const VplLights& vpls, const Bounds& box, float side) {
  std::vector<Part> parts(8 * vpls.size());
  parallelFor(vpls.size(), 1024, [&](size_t i) {
    const Vec3 at = (vpls.position[i] - box.lower) / side, n = vpls.normal[i];
    const Vec3 low(std::floor(at.x), std::floor(at.y), std::floor(at.z)), along = at - low;
    const unsigned octant = (n.x < 0.0f) | (n.y < 0.0f) << 1 | (n.z < 0.0f) << 2;
    for (unsigned corner = 0; corner < 8; ++corner) {
      uint64_t light = octant;
      float weight = 1.0f;
      for (size_t a = 0; a < 3; ++a) {
        const unsigned upper = corner >> a & 1u;
        light = light << 20 | (static_cast<uint64_t>(low[a]) + upper);
        weight *= upper ? along[a] : 1.0f - along[a];
      }
      parts[8 * i + corner] = {light, static_cast<uint32_t>(i), weight};
    }
  });
  std::erase_if(parts, [](const Part& p) { return !(p.weight > 0.0f); });
  std::ranges::sort(parts, [](const Part& a, const Part& b) {
    return a.light != b.light ? a.light < b.light : a.vpl < b.vpl;
  });
  return parts;
}

// Adds the light of a run of parts, and members drawn in proportion to their intensity.
void addLight(const VplLights& vpls, std::span<const Part> run, uint64_t key, Level& level) {
  double sum = 0.0;
  std::array<double, 7> means{};  // position, normal, squared size
  std::array<double, 3> intensity{};
  std::vector<double> upTo;
  for (const Part& p : run) {
    const double weight = double{p.weight} * double{mean(vpls.intensity[p.vpl])};
    for (size_t a = 0; a < 3; ++a) {
      means[a] += weight * double{vpls.position[p.vpl][a]};
      means[a + 3] += weight * double{vpls.normal[p.vpl][a]};
      intensity[a] += double{p.weight} * double{vpls.intensity[p.vpl][a]};
    }
    means[6] += weight * double{vpls.size2[p.vpl]};
    upTo.push_back(sum += weight);
  }
  if (!(sum > 0.0)) return;
  for (double& m : means) m /= sum;
  const auto vec3 = [](const double* v) { return Vec3(float(v[0]), float(v[1]), float(v[2])); };
  const auto light = level.lights.size();
  level.lights.position.push_back(vec3(&means[0]));
  level.lights.normal.push_back(vec3(&means[3]));
  level.lights.intensity.push_back(vec3(intensity.data()));
  level.lights.size2.push_back(static_cast<float>(means[6]));
  for (size_t m = 0; m < kMembers; ++m) {
    const double u = double(m) + double{toUnitFloat(random64(key, light, uint32_t(m)))};
    const auto at = std::ranges::upper_bound(upTo, u / double(kMembers) * sum);
    level.members.push_back(run[std::min(size_t(at - upTo.begin()), run.size() - 1)].vpl);
  }
}

size_t lightsOf(const std::vector<Part>& parts) {
  size_t lights = 0;
  for (size_t k = 0; k < parts.size(); ++k)
    lights += k == 0 || parts[k].light != parts[k - 1].light;
  return lights;
}

Level levelOf(VplLights lights, float side) {
  Bounds box;
  for (const Vec3 p : lights.position) box.extend(p);
  const CellGrid grid(box, side);
  CellPoints cells(grid, lights.position);
  return {std::move(lights), {}, std::move(cells)};
}

Level gridOf(const VplLights& vpls, const std::vector<Part>& parts, float side, uint64_t key) {
  Level made{{}, {}, {CellGrid({{}, {}}, 1.0f), {}}};
  made.lights.kind = vpls.kind;
  for (size_t begin = 0, end; begin < parts.size(); begin = end) {
    for (end = begin; end < parts.size() && parts[end].light == parts[begin].light;) ++end;
    addLight(vpls, std::span(parts).subspan(begin, end - begin), key, made);
  }
  Level level = levelOf(std::move(made.lights), side);
  level.members = std::move(made.members);
  return level;
}

}  // namespace

std::vector<Level> makeLevels(const VplLights& vpls, float alpha, uint64_t key) {
  Bounds box;
  for (const Vec3 p : vpls.position) box.extend(p);
  const float diagonal = std::max(box.diagonal(), 1e-20f);
  std::vector<Level> levels;
  for (int exponent = kFinestExponent; exponent >= 0; --exponent) {
    const float side = std::ldexp(diagonal, -exponent);
    const std::vector<Part> parts = partsOf(vpls, box, side);
    const bool pays = double(lightsOf(parts)) <= kMaxLightsPerVpl * double(vpls.size());
    if (levels.empty() && !pays) continue;
    if (levels.empty()) levels.push_back(levelOf(vpls, 0.5f * side));
    Level next = gridOf(vpls, parts, side, random64(key, uint64_t(exponent), 0));
    Level& finer = levels.back();
    finer.fall = next.from = alpha * 0.5f * side;
    finer.to = next.rise = 2.0f * finer.fall;
    levels.push_back(std::move(next));
  }
  if (levels.empty()) levels.push_back(levelOf(vpls, diagonal));
  return levels;
}

}  // namespace bnvpl::methods::gather::grid_hierarchy
