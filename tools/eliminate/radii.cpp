#include "tools/eliminate/radii.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/errors.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/random_streams.h"
#include "spatial/packed_disks.h"
#include "spatial/represented_area.h"

namespace bnvpl {
namespace {

// r_max depends on the square root of the area, so the error of about 1 % that this many rows have
// does not matter.
constexpr size_t kMaxAreaRows = 16384;
constexpr float kMaxRadius = 4e9f;  // that of the column `radius`
constexpr size_t kMaxAreaCandidates = size_t{1} << 18;

std::vector<uint32_t> evenlySpacedRows(size_t count, size_t max) {
  std::vector<uint32_t> rows(std::min(count, max));
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<uint32_t>(i * count / rows.size());
  return rows;
}

double sumOf(const std::vector<float>& values) {
  return parallelSum(values.size(), [&](size_t i) { return static_cast<double>(values[i]); });
}

double areaOf(std::span<const Vec3> position, std::span<const Vec3> normal, unsigned k,
              const ProgressFn& progress) {
  const std::vector<uint32_t> rows = evenlySpacedRows(position.size(), kMaxAreaRows);
  const KdTree tree(position);
  const auto phase = progress.beginPhase("surface area, candidates", rows.size());
  return sumOf(representedAreas(position, normal, k, tree, rows, progress)) *
         static_cast<double>(position.size()) / static_cast<double>(rows.size());
}

// Area that the candidates cover, world units squared. Many candidates are replaced by a random
// subset, each of which has a larger share: FLANN builds its tree in one thread.
double estimateArea(std::span<const Vec3> position, std::span<const Vec3> normal, unsigned k,
                    const ProgressFn& progress) {
  constexpr uint64_t kSeed = 1;  // the estimate depends on no option
  if (position.size() > kMaxAreaCandidates) {
    const uint64_t key = streamKey(kSeed, RandomStream::AreaEstimate);
    const uint64_t below = UINT64_MAX / position.size() * kMaxAreaCandidates;
    std::vector<Vec3> someOfPosition, someOfNormal;
    for (size_t i = 0; i < position.size(); ++i) {
      if (random64(key, i, 0) >= below) continue;
      someOfPosition.push_back(position[i]);
      someOfNormal.push_back(normal[i]);
    }
    return areaOf(someOfPosition, someOfNormal, k, progress);
  }
  return areaOf(position, normal, k, progress);
}

// Throws InputError unless all radii fit their column, and their squares are normal floats. They
// are not if --area is absurd or candidates lie absurdly far apart.
void requireUsable(const std::vector<float>& radii) {
  for (const float r : radii) {
    if (std::isnormal(r * r) && r <= kMaxRadius) continue;
    std::ostringstream text;
    text << "the radius of a VPL would be " << r
         << ", beyond what floats can square, or any scene; see --area, and the positions of the "
            "candidates";
    throw InputError(text.str());
  }
}

}  // namespace

CandidateRadii candidateRadii(std::span<const Vec3> position, std::span<const Vec3> normal,
                              double count, const Values& options, const ProgressFn& progress) {
  const auto candidates = static_cast<double>(position.size());
  const auto neighbours = [&] { return static_cast<unsigned>(options[kNeighboursOption]); };
  const double given = options[kAreaOption];
  CandidateRadii result;
  if (options.meet(valueIs(kDensityOption, "uniform"))) {
    result.area = given > 0.0 ? given : estimateArea(position, normal, neighbours(), progress);
    result.rMax = packedDiskRadius(result.area, count);
    result.radius.assign(position.size(), static_cast<float>(result.rMax));
    requireUsable(result.radius);
    return result;
  }
  const auto phase = progress.beginPhase("radii, candidates", position.size());
  const std::vector<float> areas = representedAreas(position, normal, neighbours(), progress);
  const double estimate = sumOf(areas);
  result.area = given > 0.0 ? given : estimate;
  result.rMax = packedDiskRadius(result.area, count);
  // VPLs per unit of area are N ((1 - w) / (M share) + w / A), which integrates to N.
  const double scale = result.area / estimate, w = options[kUniformShareOption];
  result.radius.resize(position.size());
  parallelFor(position.size(), 4096, [&](size_t i) {
    const double share = static_cast<double>(areas[i]) * scale;
    const double density = (1.0 - w) / (candidates * share) + w / result.area;
    result.radius[i] = static_cast<float>(packedDiskRadius(1.0 / density, count));
  });
  requireUsable(result.radius);
  return result;
}

}  // namespace bnvpl
