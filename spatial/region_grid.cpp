#include "spatial/region_grid.h"

#include <tbb/parallel_sort.h>

#include <bit>
#include <cmath>
#include <set>
#include <tuple>

#include "core/random.h"
#include "spatial/cell_along.h"
#include "spatial/compatible_surface.h"
#include "spatial/facing.h"

namespace bnvpl {

namespace {

// Max distance, in radii, at which a disk represents a point: about twice the distance of
// neighbours.
constexpr float kReach = 3.0f;

int levelOf(float radius) {  // binary exponent of the cell width, one to two radii
  return std::clamp(std::ilogb(2.0f * radius), -100, 100);
}

uint64_t hashOf(int64_t x, int64_t y, int64_t z, int level, uint32_t facing) {
  // Odd numbers without small common multiples keep cells apart, however far they lie.
  return mix64(static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15u +
               static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4fu +
               static_cast<uint64_t>(z) * 0x165667b19e3779f9u +
               (static_cast<uint64_t>(level + 128) << 3 | facing)) |
         1;  // 0 marks an empty slot
}

}  // namespace

struct RegionGrid::Entry {
  uint64_t key;
  float score;  // the lowest wins
  uint32_t index;
  friend bool operator<(const Entry& a, const Entry& b) {
    return std::tie(a.key, a.score, a.index) < std::tie(b.key, b.score, b.index);
  }
};

RegionGrid::RegionGrid(std::span<const Vec3> points, std::span<const Vec3> normals,
                       std::span<const float> radii) {
  if (points.empty()) return;
  origin_ = points[0];
  std::set<int> levels;
  for (const float r : radii) levels.insert(levelOf(r));
  for (const int level : levels) {
    levels_.push_back(level);
    perUnit_.push_back(std::ldexp(1.0f, -level));
  }
  std::vector<Entry> entries;
  for (size_t i = 0; i < points.size(); ++i)
    list(static_cast<uint32_t>(i), points[i], normals[i], radii[i], entries);
  fill(entries);
}

// Lists the cells within reach that the disk's plane crosses, for each facing near its normal.
void RegionGrid::list(uint32_t index, Vec3 point, Vec3 normal, float radius,
                      std::vector<Entry>& out) const {
  const int level = levelOf(radius);
  const float cell = std::ldexp(1.0f, level), perUnit = std::ldexp(1.0f, -level);
  const float reach = kReach * radius;
  const Vec3 centre = point - origin_;
  const auto low = [&](float v) { return cellAlong((v - reach) * perUnit); };
  const auto high = [&](float v) { return cellAlong((v + reach) * perUnit); };
  for (int64_t z = low(centre.z); z <= high(centre.z); ++z) {
    for (int64_t y = low(centre.y); y <= high(centre.y); ++y) {
      for (int64_t x = low(centre.x); x <= high(centre.x); ++x) {
        const Vec3 middle = Vec3{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f} * cell;
        const Vec3 apart = middle - centre;
        // Half the extent of a cell along the normal, and a tolerance for curved surfaces.
        const float thick =
            0.5f * cell * (std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z)) +
            kPlaneFactor * radius;
        if (lengthSquared(apart) > reach * reach || std::fabs(dot(apart, normal)) > thick) continue;
        for (uint32_t facing = 0; facing < kFacings; ++facing) {
          const float cosine = dot(normal, axisOf(facing));
          if (cosine < kMinNormalDot) continue;
          out.push_back({hashOf(x, y, z, level, facing),
                         lengthSquared(apart) / (radius * radius) + 4.0f * (1.0f - cosine), index});
        }
      }
    }
  }
}

void RegionGrid::fill(std::vector<Entry>& entries) {
  tbb::parallel_sort(entries.begin(), entries.end());  // deterministic, because the order is total
  const auto end = std::unique(entries.begin(), entries.end(),
                               [](const Entry& a, const Entry& b) { return a.key == b.key; });
  const auto count = static_cast<size_t>(end - entries.begin());
  slots_.resize(std::bit_ceil(2 * count + 1));
  mask_ = slots_.size() - 1;
  for (size_t i = 0; i < count; ++i) {
    uint64_t slot = entries[i].key >> 1 & mask_;
    while (slots_[slot].key != 0) slot = (slot + 1) & mask_;
    slots_[slot] = {entries[i].key, entries[i].index};
  }
}

uint32_t RegionGrid::at(Vec3 position, Vec3 normal) const {
  const Vec3 d = position - origin_;
  const uint32_t facing = facingOf(normal);
  for (size_t l = 0; l < levels_.size(); ++l) {
    const Vec3 c = d * perUnit_[l];
    const uint64_t key = hashOf(cellAlong(c.x), cellAlong(c.y), cellAlong(c.z), levels_[l], facing);
    for (uint64_t slot = key >> 1 & mask_; slots_[slot].key != 0; slot = (slot + 1) & mask_) {
      if (slots_[slot].key == key) return slots_[slot].index;
    }
  }
  return UINT32_MAX;
}

}  // namespace bnvpl
