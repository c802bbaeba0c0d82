#include "tools/render/gather/shirley/bright_lights.h"

#include <algorithm>

#include "core/memory.h"

namespace bnvpl::methods::gather::shirley {

BrightLights::BrightLights(const VplLights& vpls, const Bounds& scene, uint32_t cells,
                           float threshold)
    : vpls_(vpls),
      grid_(scene, std::max(maxComponent(scene.extent()), 1e-20f) / static_cast<float>(cells)),
      threshold_(threshold),
      upTo_(1, 0.0) {
  for (const Vec3 i : vpls.intensity) upTo_.push_back(upTo_.back() + double{mean(i)});
}

const BrightLights::Cell& BrightLights::at(Vec3 position) const {
  const size_t index = grid_.at(position);
  auto found = cells_.find(index);
  if (found == cells_.end()) found = cells_.emplace(index, std::make_unique<LazyCell>()).first;
  LazyCell& lazy = *found->second;
  std::call_once(lazy.once, [&] {
    lazy.cell = find(grid_.bounds(index));
    requireRoomFor(lazy.cell.bright.size());
  });
  return lazy.cell;
}

// The lists of all cells may exceed the memory; their number is known only at the end.
void BrightLights::requireRoomFor(size_t more) const {
  constexpr uint64_t kUnchecked = 1 << 20;  // entries
  constexpr double kRoom = 16.0 * kUnchecked * (sizeof(uint32_t) + sizeof(double));
  const uint64_t before = entries_.fetch_add(more, std::memory_order_relaxed);
  if (before / kUnchecked == (before + more) / kUnchecked) return;
  requireMemory(kRoom, "lists of bright VPLs", "raise --threshold, or lower --cells");
}

BrightLights::Cell BrightLights::find(const Bounds& box) const {
  const Vec3 centre = box.center();
  const float radius = 0.5f * length(box.extent());
  std::vector<float> most(vpls_.size());  // irradiance that no point of the cell exceeds, W/m2
  double arriving = 0.0;  // from all VPLs at the cell, with their largest emission towards it
  for (size_t i = 0; i < vpls_.size(); ++i) {
    const Vec3 to = vpls_.position[i] - centre, half = 0.5f * vpls_.box(i).extent();
    const float d2 = lengthSquared(to), intensity = mean(vpls_.intensity[i]);
    const float reach = radius + length(half);
    float cosine = 1.0f;
    if (d2 > reach * reach) {
      const float sinSphere = reach / std::sqrt(d2);
      cosine =
          cosSubClamped(-dot(vpls_.normal[i], to) / std::sqrt(d2), sineOf(sinSphere), sinSphere);
    }
    const float emitted =
        intensity * withKind(vpls_.kind, [&](auto k) { return k.maxEmitted(cosine, 1.0f, 0.0f); });
    const Bounds grown{box.lower - half, box.upper + half};
    most[i] =
        emitted * maxFalloff(vpls_.kind, grown.distanceSquared(vpls_.position[i]), vpls_.size2[i]);
    arriving += double{emitted * falloff(vpls_.kind, larger(d2, radius * radius), vpls_.size2[i])};
  }
  Cell cell;
  cell.upTo.assign(1, 0.0);
  for (uint32_t i = 0; i < most.size(); ++i) {
    if (!(double{most[i]} > double{threshold_} * arriving)) continue;
    cell.bright.push_back(i);
    cell.upTo.push_back(cell.upTo.back() + double{mean(vpls_.intensity[i])});
  }
  return cell;
}

std::optional<BrightLights::Draw> BrightLights::drawDim(const Cell& cell, float u) const {
  if (cell.bright.size() == vpls_.size()) return {};
  // Intensity of the dim VPLs before number i.
  const auto dimUpTo = [&](size_t i) {
    const auto bright = std::ranges::lower_bound(cell.bright, i) - cell.bright.begin();
    return upTo_[i] - cell.upTo[size_t(bright)];
  };
  const double all = dimUpTo(vpls_.size());
  const double wanted = double{u} * all;
  size_t first = 0, end = vpls_.size();  // the VPL is in [first, end)
  while (end - first > 1) {
    const size_t middle = first + (end - first) / 2;
    (dimUpTo(middle) <= wanted ? first : end) = middle;
  }
  // Rounding of the sums may lead to a bright VPL, which has been counted.
  if (std::ranges::binary_search(cell.bright, first)) return {};
  const double own = double{mean(vpls_.intensity[first])};
  if (!(own > 0.0) || !(all > 0.0)) return {};
  return Draw{static_cast<uint32_t>(first), static_cast<float>(own / all)};
}

}  // namespace bnvpl::methods::gather::shirley
