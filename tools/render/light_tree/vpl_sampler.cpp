#include "tools/render/light_tree/vpl_sampler.h"

#include <algorithm>

namespace bnvpl {

namespace {

// Lower bound of the squared distance to a cluster, over its squared radius: most of a cluster
// around the point is farther away than its centre (measured).
constexpr float kMinDistance = 2.0f;
// Least cosine with which spheres count, whose light may come from across a horizon.
constexpr float kMinOfSphere = 0.1f;

__m128 all(float v) { return _mm_set1_ps(v); }
__m128 load(const std::array<float, 4>& lanes) { return _mm_load_ps(lanes.data()); }  // aligned
std::array<float, 4> store(__m128 v) {
  std::array<float, 4> out;
  _mm_storeu_ps(out.data(), v);
  return out;
}

}  // namespace

// Directions from a point to four spheres.
struct VplSampler::SphereDirections {
  __m128 x, y, z;               // unit, to the centres
  __m128 cosSphere, sinSphere;  // half of the angle that each subtends
  __m128 radius2, d2;           // squared radii, squared distances of the centres
  // Largest cosine between an axis and any direction into the sphere.
  __m128 most(__m128 ax, __m128 ay, __m128 az) const {
    return selectAtLeast(radius2, d2, all(1.0f),
                         cosSubClamped(ax * x + ay * y + az * z, cosSphere, sinSphere));
  }
};

VplSampler::VplSampler(const LightTree& tree) {
  if (tree.nodes.empty()) return;
  kind_ = tree.nodes.front().kind;
  const std::span<const uint32_t> cut = tree.startCut;
  startNodes_ = (cut.size() + 3) / 4;
  nodes_.reserve(startNodes_ + tree.nodes.size() / 3);
  nodes_.resize(startNodes_);
  for (size_t f = 0; f < startNodes_; ++f) {
    fill(tree, cut.subspan(4 * f, std::min<size_t>(4, cut.size() - 4 * f)), f);
  }
}

uint32_t VplSampler::add(const LightTree& tree, std::span<const uint32_t> nodes) {
  const auto node = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  fill(tree, nodes, node);
  return node;
}

void VplSampler::fill(const LightTree& tree, std::span<const uint32_t> nodes, size_t node) {
  Node4 f;
  for (size_t lane = 0; lane < nodes.size(); ++lane) {
    const LightNode& n = tree.nodes[nodes[lane]];
    const Vec3 center = n.bounds.center();
    f.x[lane] = center.x, f.y[lane] = center.y, f.z[lane] = center.z;
    f.radius2[lane] = 0.25f * lengthSquared(n.bounds.extent());
    f.ax[lane] = n.axis.x, f.ay[lane] = n.axis.y, f.az[lane] = n.axis.z;
    f.cosHalf[lane] = n.cosHalfAngle, f.sinHalf[lane] = n.sinHalfAngle;
    f.red[lane] = n.intensity.x, f.green[lane] = n.intensity.y, f.blue[lane] = n.intensity.z;
    f.size2[lane] = n.size2;
    if (n.leaf()) {
      f.child[lane] = kLeaf | n.representative;
      continue;
    }
    std::array<uint32_t, 4> below{};  // nodes two levels down
    size_t count = 0;
    for (const uint32_t c : {n.left, n.right}) {
      const LightNode& m = tree.nodes[c];
      if (m.leaf()) {
        below[count++] = c;
      } else {
        below[count++] = m.left;
        below[count++] = m.right;
      }
    }
    f.child[lane] = add(tree, std::span(below).first(count));
  }
  nodes_[node] = f;
}

VplSampler::Point::Point(const VplSampler& sampler, const Bsdf& bsdf)
    : sampler_(sampler),
      bsdf_(bsdf),
      at_(bsdf.point().position),
      normal_(bsdf.point().ns),
      value_(bsdf.diffuseValue()),
      diffuse_(bsdf.diffuseOnly()) {
  for (uint32_t f = 0; f < sampler.startNodes_; ++f) {
    for (const float weight : likely(f)) upTo_[starts_++] = whole_ += weight;
  }
}

VplSampler::Lanes VplSampler::Point::likely(uint32_t node) const {
  return withKind(sampler_.kind_, [&](auto kind) { return likelyOf<decltype(kind)>(node); });
}

template <typename Kind>
VplSampler::Lanes VplSampler::Point::likelyOf(uint32_t node) const {
  const Node4& f = sampler_.nodes_[node];
  const __m128 x = load(f.x) - all(at_.x), y = load(f.y) - all(at_.y), z = load(f.z) - all(at_.z);
  const __m128 d2 = x * x + y * y + z * z, radius2 = load(f.radius2);
  const __m128 inverse = all(1.0f) / _mm_sqrt_ps(d2);  // infinite only inside
  SphereDirections to;
  to.radius2 = radius2, to.d2 = d2;
  to.x = x * inverse, to.y = y * inverse, to.z = z * inverse;
  to.sinSphere = _mm_sqrt_ps(radius2) * inverse;
  to.cosSphere = sineOf(to.sinSphere);

  const __m128 zero = _mm_setzero_ps();
  // Emission leaves in the opposite directions, so the axes are negated instead.
  const __m128 back = to.most(zero - load(f.ax), zero - load(f.ay), zero - load(f.az));
  const __m128 least = Kind::fromCentre ? zero : all(kMinOfSphere);
  const __m128 emitter = larger(Kind::maxEmitted(back, load(f.cosHalf), load(f.sinHalf)), least);
  const __m128 cosine = larger(to.most(all(normal_.x), all(normal_.y), all(normal_.z)), least);
  __m128 value;
  if (diffuse_) {
    value =
        all(value_.x) * load(f.red) + all(value_.y) * load(f.green) + all(value_.z) * load(f.blue);
  } else {
    // Glossy lobes are bounded by the cosine to their axis; those over a normal of their own, such
    // as a coat's, have another.
    Vec3 known;
    Lanes cosines{};
    const auto cosinesTo = [&](Vec3 axis) -> const Lanes& {
      if (axis != known) {
        known = axis;
        cosines = store(to.most(all(axis.x), all(axis.y), all(axis.z)));
      }
      return cosines;
    };
    alignas(16) Lanes sums;
    for (size_t lane = 0; lane < 4; ++lane) {
      const Vec3 v = bsdf_.roughUpperBound(1.0f, [&](Vec3 axis) { return cosinesTo(axis)[lane]; });
      sums[lane] = v.x * f.red[lane] + v.y * f.green[lane] + v.z * f.blue[lane];
    }
    value = load(sums);
  }
  const __m128 away2 = larger(d2, all(kMinDistance) * radius2);
  return store(value * cosine * emitter / Kind::boundedDistance2(away2, load(f.size2)));
}

std::optional<VplSample> VplSampler::Point::draw(float u, Rng& rng) const {
  const auto begin = upTo_.begin(), end = begin + static_cast<std::ptrdiff_t>(starts_);
  const auto slot =
      std::min(starts_ - 1, static_cast<size_t>(std::upper_bound(begin, end, u * whole_) - begin));
  float probability = (upTo_[slot] - (slot > 0 ? upTo_[slot - 1] : 0.0f)) / whole_;
  uint32_t child = sampler_.nodes_[slot / 4].child[slot % 4];
  while ((child & kLeaf) == 0 && probability > 0.0f) {
    const Lanes weight = likely(child);
    const float sum = weight[0] + weight[1] + weight[2] + weight[3];
    if (!(sum > 0.0f)) return {};
    const float pick = rng.next() * sum;
    size_t lane = 0;
    for (float below = weight[0]; lane < 3 && pick >= below; below += weight[lane]) ++lane;
    probability *= weight[lane] / sum;
    child = sampler_.nodes_[child].child[lane];
  }
  // Rounding may select the last slot or lane even if its probability is 0.
  if (!(probability > 0.0f)) return {};
  return VplSample{child & ~kLeaf, probability};
}

}  // namespace bnvpl
