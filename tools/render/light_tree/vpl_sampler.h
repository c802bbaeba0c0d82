// Samples single VPLs about in proportion to their contribution at a point, by descending a tree
// whose nodes hold four clusters of the light tree side by side (after Conty Estevez & Kulla 2018).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/random.h"
#include "tools/render/light_tree/light_tree.h"
#include "transport/bsdf.h"

namespace bnvpl {

class VplSampler {
  using Lanes = std::array<float, 4>;

 public:
  explicit VplSampler(const LightTree& tree);

  // Sampling distribution at one point. Borrows both arguments.
  class Point {
   public:
    Point(const VplSampler& sampler, const Bsdf& bsdf);
    bool dark() const { return !(whole_ > 0.0f); }  // no VPL can light it
    // Draws a VPL. u in [0, 1) selects a cluster of the start cut and should be stratified over the
    // draws of a point. Returns nothing if the descent reaches clusters that cannot light the
    // point. Must not be called if dark().
    std::optional<VplSample> draw(float u, Rng& rng) const;

   private:
    // Estimated light of each of four clusters without visibility, W/(m2 sr); 0 only if no light
    // can arrive.
    Lanes likely(uint32_t node) const;
    template <typename Kind>
    Lanes likelyOf(uint32_t node) const;

    const VplSampler& sampler_;
    const Bsdf& bsdf_;
    Vec3 at_, normal_, value_;
    bool diffuse_;
    std::array<float, kMaxStartCut> upTo_;  // running sums over the start cut
    size_t starts_ = 0;
    float whole_ = 0.0f;
  };

 private:
  struct SphereDirections;
  struct alignas(16) Node4 {
    Lanes x{}, y{}, z{};              // centres of the spheres about the boxes
    Lanes radius2{};                  // squared radii of the spheres
    Lanes ax{}, ay{}, az{};           // axes of the cones of normals
    Lanes cosHalf{}, sinHalf{};       // cosines and sines of their half angles
    Lanes red{}, green{}, blue{};     // intensities, W/sr; 0 in an empty lane
    Lanes size2{1, 1, 1, 1};          // see LightNode
    std::array<uint32_t, 4> child{};  // index of another Node4, or kLeaf and a VPL
  };
  static constexpr uint32_t kLeaf = 1u << 31;

  uint32_t add(const LightTree& tree, std::span<const uint32_t> nodes);
  void fill(const LightTree& tree, std::span<const uint32_t> nodes, size_t node);

  std::vector<Node4> nodes_;  // begins with those of the start cut
  size_t startNodes_ = 0;
  VplKind kind_ = {};
};

}  // namespace bnvpl
