#include "tools/render/gather/paquette/light_octree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/random.h"

namespace bnvpl::methods::gather::paquette {

namespace {

// Smaller cells are divided by number instead, for VPLs that coincide.
constexpr unsigned kMaxDepth = 40;

unsigned octantOf(Vec3 v) { return (v.x < 0.0f) | (v.y < 0.0f) << 1 | (v.z < 0.0f) << 2; }

class Builder {
 public:
  Builder(const VplLights& vpls, uint64_t key, LightOctree& tree)
      : vpls_(vpls), key_(key), tree_(tree) {
    tree_.lights.kind = vpls.kind;
  }

  uint32_t add() {
    VplLights& l = tree_.lights;
    l.position.emplace_back(), l.normal.emplace_back(), l.intensity.emplace_back();
    l.size2.emplace_back();
    tree_.nodes.emplace_back();
    return static_cast<uint32_t>(tree_.nodes.size() - 1);
  }

  void fill(uint32_t node, std::span<uint32_t> vpls, const Bounds& cube, unsigned depth) {
    describe(node, vpls);
    if (vpls.size() == 1) return;
    const Vec3 centre = cube.center();
    std::vector<std::span<uint32_t>> parts;
    std::vector<Bounds> cubes;
    if (depth < kMaxDepth) {
      const auto octant = [&](uint32_t i) { return octantOf(vpls_.position[i] - centre); };
      std::ranges::stable_sort(vpls, {}, octant);
      for (size_t begin = 0, end; begin < vpls.size(); begin = end) {
        for (end = begin; end < vpls.size() && octant(vpls[end]) == octant(vpls[begin]);) ++end;
        parts.push_back(vpls.subspan(begin, end - begin));
        cubes.push_back(octantCube(cube, octant(vpls[begin])));
      }
    } else {
      parts = {vpls.first(vpls.size() / 2), vpls.subspan(vpls.size() / 2)};
      cubes = {cube, cube};
    }
    if (parts.size() == 1) return fill(node, vpls, cubes[0], depth + 1);
    const uint32_t first = add();
    for (size_t k = 1; k < parts.size(); ++k) add();
    tree_.nodes[node].firstChild = first;
    tree_.nodes[node].children = static_cast<uint32_t>(parts.size());
    for (size_t k = 0; k < parts.size(); ++k)
      fill(first + static_cast<uint32_t>(k), parts[k], cubes[k], depth + 1);
  }

 private:
  static Bounds octantCube(const Bounds& cube, unsigned octant) {
    Bounds part = cube;
    for (size_t a = 0; a < 3; ++a)
      (octant >> a & 1u ? part.upper : part.lower)[a] = cube.center()[a];
    return part;
  }

  void describe(uint32_t node, std::span<const uint32_t> vpls) {
    OctreeNode n;
    std::array<double, 10> sums{};  // position, normal, intensity, squared size
    double weights = 0.0;
    for (const uint32_t i : vpls) {
      const double weight = double{bnvpl::mean(vpls_.intensity[i])};
      for (size_t a = 0; a < 3; ++a) {
        sums[a] += weight * double{vpls_.position[i][a]};
        sums[a + 3] += weight * double{vpls_.normal[i][a]};
        sums[a + 6] += double{vpls_.intensity[i][a]};
      }
      sums[9] += weight * double{vpls_.size2[i]};
      weights += weight;
      n.cone = n.bounds.empty() ? NormalCone{vpls_.normal[i]}
                                : merged(n.cone, NormalCone{vpls_.normal[i]});
      n.bounds.extend(vpls_.box(i));
      n.minSize2 = std::min(n.minSize2, vpls_.size2[i]);
      n.maxSize2 = std::max(n.maxSize2, vpls_.size2[i]);
      // Replaces the VPL so far with the probability of the new one's share.
      const double u = double{toUnitFloat(random64(key_, node, i))};
      if (u * weights < weight) n.shadow = i;
    }
    tree_.nodes[node] = n;
    VplLights& l = tree_.lights;
    if (vpls.size() == 1) {  // exactly the VPL
      l.position[node] = vpls_.position[vpls[0]], l.normal[node] = vpls_.normal[vpls[0]];
      l.intensity[node] = vpls_.intensity[vpls[0]], l.size2[node] = vpls_.size2[vpls[0]];
      return;
    }
    const auto vec3 = [&](size_t at, double scale) {
      return Vec3(float(sums[at] * scale), float(sums[at + 1] * scale),
                  float(sums[at + 2] * scale));
    };
    l.position[node] = vec3(0, 1.0 / weights), l.normal[node] = vec3(3, 1.0 / weights);
    l.intensity[node] = vec3(6, 1.0);
    l.size2[node] = static_cast<float>(sums[9] / weights);
  }

  const VplLights& vpls_;
  uint64_t key_;
  LightOctree& tree_;
};

}  // namespace

LightOctree buildLightOctree(const VplLights& vpls, uint64_t key) {
  LightOctree tree;
  std::array<std::vector<uint32_t>, 8> byNormal;
  Bounds box;
  for (uint32_t i = 0; i < vpls.size(); ++i) {
    byNormal[octantOf(vpls.normal[i])].push_back(i);
    box.extend(vpls.position[i]);
  }
  const float side = maxComponent(box.extent());
  const Bounds cube{box.lower, box.lower + Vec3(side)};
  Builder builder(vpls, key, tree);
  for (std::vector<uint32_t>& octant : byNormal) {
    if (octant.empty()) continue;
    tree.roots.push_back(builder.add());
    builder.fill(tree.roots.back(), octant, cube, 0);
  }
  return tree;
}

}  // namespace bnvpl::methods::gather::paquette
