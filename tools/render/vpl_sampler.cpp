#include "tools/render/vpl_sampler.h"

#include <emmintrin.h>

#include <algorithm>

namespace bnvpl {

namespace {

// Squared distance that counts at least, over the squared radius of a cluster: it lies around the
// point, most of it further away than its middle (measured).
constexpr float kClosest = 2.0f;

__m128 all(float v) { return _mm_set1_ps(v); }
__m128 select(__m128 mask, __m128 yes, __m128 no) {
  return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
}
__m128 sineOf(__m128 cosine) {
  return _mm_sqrt_ps(_mm_max_ps(_mm_setzero_ps(), all(1.0f) - cosine * cosine));
}
// Cosine of an angle that is smaller by another, but not below 0.
__m128 cosineOfLess(__m128 cosine, __m128 cosLess, __m128 sinLess) {
  const __m128 turned = cosine * cosLess + sineOf(cosine) * sinLess;
  return select(_mm_cmpge_ps(cosine, cosLess), all(1.0f), turned);
}

// From a point to four spheres.
struct Directions {
  __m128 x, y, z;               // unit, to the centres
  __m128 cosSphere, sinSphere;  // of half the angle that each takes
  __m128 inside;                // mask
  // Largest cosine between an axis and any direction into the sphere.
  __m128 most(__m128 ax, __m128 ay, __m128 az) const {
    return select(inside, all(1.0f), cosineOfLess(ax * x + ay * y + az * z, cosSphere, sinSphere));
  }
};

}  // namespace

VplSampler::VplSampler(const LightTree& tree) {
  if (tree.nodes.empty()) return;
  const std::span<const uint32_t> cut = tree.startCut;
  startFours_ = (cut.size() + 3) / 4;
  fours_.reserve(startFours_ + tree.nodes.size() / 3);
  fours_.resize(startFours_);
  for (uint32_t f = 0; f < startFours_; ++f) {
    fill(tree, cut.subspan(4 * f, std::min<size_t>(4, cut.size() - 4 * f)), f);
  }
}

uint32_t VplSampler::add(const LightTree& tree, std::span<const uint32_t> nodes) {
  const auto four = static_cast<uint32_t>(fours_.size());
  fours_.emplace_back();
  fill(tree, nodes, four);
  return four;
}

void VplSampler::fill(const LightTree& tree, std::span<const uint32_t> nodes, uint32_t four) {
  alignas(16) float v[13][4] = {};  // an empty lane has no intensity
  std::array<uint32_t, 4> child{};
  for (size_t lane = 0; lane < 4; ++lane) v[12][lane] = 1.0f;
  for (size_t lane = 0; lane < nodes.size(); ++lane) {
    const LightNode& n = tree.nodes[nodes[lane]];
    const Vec3 center = n.bounds.center();
    const float radius2 = 0.25f * lengthSquared(n.bounds.extent());
    const float values[13] = {center.x,
                              center.y,
                              center.z,
                              radius2,
                              n.axis.x,
                              n.axis.y,
                              n.axis.z,
                              n.cosHalfAngle,
                              n.sinHalfAngle,
                              n.intensity.x,
                              n.intensity.y,
                              n.intensity.z,
                              std::max(n.clamp2, kClosest * radius2)};
    for (size_t k = 0; k < 13; ++k) v[k][lane] = values[k];
    if (n.leaf()) {
      child[lane] = kLeaf | n.representative;
      continue;
    }
    std::array<uint32_t, 4> below{};  // two levels down
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
    child[lane] = add(tree, std::span(below).first(count));
  }
  Four& f = fours_[four];
  __m128* fields[13] = {&f.x,       &f.y,       &f.z,   &f.radius2, &f.ax,   &f.ay,      &f.az,
                        &f.cosHalf, &f.sinHalf, &f.red, &f.green,   &f.blue, &f.closest2};
  for (size_t k = 0; k < 13; ++k) *fields[k] = _mm_load_ps(v[k]);
  f.child = child;
}

VplSampler::Point::Point(const VplSampler& sampler, const Bsdf& bsdf)
    : sampler_(sampler),
      bsdf_(bsdf),
      at_(bsdf.point().position),
      normal_(bsdf.point().ns),
      value_(bsdf.diffuseValue()),
      diffuse_(bsdf.diffuseOnly()) {
  for (uint32_t f = 0; f < sampler.startFours_; ++f) {
    for (const float weight : likely(f)) upTo_[starts_++] = whole_ += weight;
  }
}

std::array<float, 4> VplSampler::Point::likely(uint32_t four) const {
  const Four& f = sampler_.fours_[four];
  const __m128 x = f.x - all(at_.x), y = f.y - all(at_.y), z = f.z - all(at_.z);
  const __m128 d2 = x * x + y * y + z * z;
  const __m128 inverse = all(1.0f) / _mm_sqrt_ps(d2);  // infinite only inside
  Directions to;
  to.inside = _mm_cmple_ps(d2, f.radius2);
  to.x = x * inverse, to.y = y * inverse, to.z = z * inverse;
  to.sinSphere = _mm_sqrt_ps(f.radius2) * inverse;
  to.cosSphere = sineOf(to.sinSphere);

  const __m128 zero = _mm_setzero_ps();
  // The way back is the mirror image of the way there.
  const __m128 back = to.most(zero - f.ax, zero - f.ay, zero - f.az);
  const __m128 emitter =
      select(_mm_cmple_ps(f.cosHalf, zero), all(1.0f), cosineOfLess(back, f.cosHalf, f.sinHalf));
  const __m128 cosine = to.most(all(normal_.x), all(normal_.y), all(normal_.z));
  __m128 value;
  if (diffuse_) {
    value = all(value_.x) * f.red + all(value_.y) * f.green + all(value_.z) * f.blue;
  } else {
    // Lobes go by their axis as the normal does.
    alignas(16) float sums[4];
    std::optional<std::array<float, 4>> toAxis;
    alignas(16) float red[4], green[4], blue[4];
    _mm_store_ps(red, f.red), _mm_store_ps(green, f.green), _mm_store_ps(blue, f.blue);
    for (size_t lane = 0; lane < 4; ++lane) {
      const Vec3 v = bsdf_.roughUpperBound(1.0f, [&](Vec3 axis) {
        if (!toAxis) {
          alignas(16) float cosines[4];
          _mm_store_ps(cosines, to.most(all(axis.x), all(axis.y), all(axis.z)));
          toAxis = {cosines[0], cosines[1], cosines[2], cosines[3]};
        }
        return (*toAxis)[lane];
      });
      sums[lane] = v.x * red[lane] + v.y * green[lane] + v.z * blue[lane];
    }
    value = _mm_load_ps(sums);
  }
  const __m128 sum =
      value * _mm_max_ps(cosine, zero) * _mm_max_ps(emitter, zero) / _mm_max_ps(d2, f.closest2);
  std::array<float, 4> out;
  _mm_storeu_ps(out.data(), sum);
  return out;
}

std::optional<VplSampler::Draw> VplSampler::Point::draw(float u, Rng& rng) const {
  const auto begin = upTo_.begin(), end = begin + static_cast<std::ptrdiff_t>(starts_);
  const auto slot =
      std::min(starts_ - 1, static_cast<size_t>(std::upper_bound(begin, end, u * whole_) - begin));
  float probability = (upTo_[slot] - (slot > 0 ? upTo_[slot - 1] : 0.0f)) / whole_;
  uint32_t child = sampler_.fours_[slot / 4].child[slot % 4];
  while ((child & kLeaf) == 0 && probability > 0.0f) {
    const std::array<float, 4> weight = likely(child);
    const float sum = weight[0] + weight[1] + weight[2] + weight[3];
    if (!(sum > 0.0f)) return {};
    const float pick = rng.next() * sum;
    size_t lane = 0;
    for (float below = weight[0]; lane < 3 && pick >= below; below += weight[lane]) ++lane;
    probability *= weight[lane] / sum;
    child = sampler_.fours_[child].child[lane];
  }
  // The last slot or lane is also taken by rounding, even where its own share is 0.
  if (!(probability > 0.0f)) return {};
  return Draw{child & ~kLeaf, probability};
}

}  // namespace bnvpl
