// Single VPLs at random, about in proportion to what they will send to a point: down a tree whose
// nodes hold four clusters of the light tree side by side (after Estevez & Kulla 2018).
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

  struct Draw {
    uint32_t vpl;
    float probability;  // > 0
  };

  // What to expect at one point. Borrows both.
  class Point {
   public:
    Point(const VplSampler& sampler, const Bsdf& bsdf);
    bool dark() const { return !(whole_ > 0.0f); }  // no VPL can light it
    // By u in [0, 1), which says where to start: over the draws of a point it should be stratified.
    // Empty: this time none, as a cluster that may light the point holds no VPL that does. Not for
    // dark points.
    std::optional<Draw> draw(float u, Rng& rng) const;

   private:
    // What each of four clusters will likely send, W/(m2 sr) up to visibility; 0 only where nothing
    // can arrive.
    Lanes likely(uint32_t four) const;
    template <typename Kind>
    Lanes likelyOf(uint32_t four) const;

    const VplSampler& sampler_;
    const Bsdf& bsdf_;
    Vec3 at_, normal_, value_;
    bool diffuse_;
    std::array<float, kMaxStartCut> upTo_;  // running sums over the start cut
    size_t starts_ = 0;
    float whole_ = 0.0f;
  };

 private:
  struct alignas(16) Four {
    Lanes x{}, y{}, z{};              // centres of the spheres about the boxes
    Lanes radius2{};                  // of the spheres
    Lanes ax{}, ay{}, az{};           // of the cones of normals
    Lanes cosHalf{}, sinHalf{};       // of their half angles
    Lanes red{}, green{}, blue{};     // intensities, W/sr; 0: an empty lane
    Lanes clamp2{1, 1, 1, 1};         // as of LightNode
    std::array<uint32_t, 4> child{};  // another four, or kLeaf and a VPL
  };
  static constexpr uint32_t kLeaf = 1u << 31;

  uint32_t add(const LightTree& tree, std::span<const uint32_t> nodes);
  void fill(const LightTree& tree, std::span<const uint32_t> nodes, size_t four);

  std::vector<Four> fours_;  // the start cut's first
  size_t startFours_ = 0;
  LightKind kind_ = {};
};

}  // namespace bnvpl
