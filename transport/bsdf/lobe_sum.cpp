#include "transport/bsdf/lobe_sum.h"

#include <memory>
#include <type_traits>

#include "transport/bsdf/diffuse_transmission/diffuse_transmission.h"
#include "transport/bsdf/mix/mix.h"

namespace bnvpl {

static_assert(std::is_trivially_copyable_v<LobeSum> && std::is_trivially_destructible_v<LobeSum>);

namespace {

// The mirror image of wo lies at least so far above the geometric surface, as a cosine.
constexpr float kAboveSurface = 0.01f;

// The shading normal for lobes that look for wo's mirror image: where that lies below the surface,
// or wo below the shading normal's horizon, the one whose mirror image is just above. It moves
// continuously.
Vec3 bentNormal(const SurfacePoint& p) {
  const Vec3 mirror = reflect(p.wo, p.ns);
  const float up = dot(mirror, p.ng), least = std::min(kAboveSurface, 0.9f * dot(p.ng, p.wo));
  if (dot(p.ns, p.wo) > 0.0f && up >= least) return p.ns;
  const Vec3 along = mirror - p.ng * up;
  const float length2 = lengthSquared(along);
  if (!(length2 > 1e-12f) || !(least > 0.0f)) return p.ng;
  const Vec3 raised = along * std::sqrt((1.0f - least * least) / length2) + p.ng * least;
  return normalize(p.wo + raised);
}

constexpr float kLeastCosine = 1e-5f;  // of wo: lobes divide by it

bool isLambert(const Lobe& lobe) { return std::holds_alternative<LambertLobe>(lobe); }

// The mean over directions of a diffuse base, cosine-weighted.
float meanThrough(const CoatAbove& above, float most) {
  constexpr int kSteps = 8;
  float sum = 0.0f;
  for (int i = 0; i < kSteps; ++i)
    sum += std::min(most, above.through(std::sqrt((float(i) + 0.5f) / kSteps)));
  return sum / kSteps;
}

}  // namespace

float CoatAbove::through(float cosine) const {
  return 1.0f - weight * ggxAlbedo({Vec3(0.04f), Vec3(1), {}}, cosine, alpha).x;
}

void addModel(const MaterialModel& model, const MaterialInputs& inputs, Vec3 weight, LobeSum& out) {
  std::visit(
      [&](const auto& m) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(m)>, PhongModel>)
          addLobes(m, inputs, weight, out);
      },
      model);
}

LobeSum::LobeSum(const Scene& scene, const MaterialModel& model, const SurfacePoint& point) {
  setFrame(point);
  addModel(model, MaterialInputs(scene, point), Vec3(1), *this);
  finish();
}

void LobeSum::setFrame(const SurfacePoint& point) {
  const Vec3 n = bentNormal(point);
  bent_ = n != point.ns;
  const Vec3 along = point.tangent - n * dot(n, point.tangent);
  const Basis basis(n);
  frame_[2] = n;
  frame_[0] = lengthSquared(along) > 1e-8f ? normalize(along) : basis.s;
  frame_[1] = cross(n, frame_[0]);
  wo_ = toLocal(point.wo);
  wo_.z = std::max(kLeastCosine, wo_.z);
}

void LobeSum::add(Vec3 weight, const Lobe& lobe, CoatAbove above) {
  if (full()) return;
  Summand s;
  s.lobe = lobe;
  s.weight = weight;
  s.above = above;
  std::visit(
      [&](const auto& l) {
        s.group = l.group();
        s.albedo = weight * l.albedo(wo_);
      },
      lobe);
  if (above.weight > 0.0f) {
    s.coatOut = above.through(wo_.z);
    const bool diffuse = s.group == LobeGroup::Rough && std::holds_alternative<LayeredBase>(lobe);
    s.albedo *= diffuse ? meanThrough(above, s.coatOut) : s.coatOut;
  }
  if (isBlack(s.albedo)) return;
  std::construct_at(&lobes_[count_++], s);
}

void LobeSum::finish() {
  float rough = 0.0f, specular = 0.0f;
  Vec3 all;
  for (const Summand& s : lobes()) {
    (s.group == LobeGroup::Rough ? rough : specular) += maxComponent(s.albedo);
    all += s.albedo;
    if (s.group == LobeGroup::Specular) {
      specularIsDelta_ &= std::visit([](const auto& l) { return l.smooth(); }, s.lobe);
      continue;
    }
    roughAlbedo_ += s.albedo;
    if (isLambert(s.lobe))
      diffuseValue_ += s.weight * std::get<LambertLobe>(s.lobe).colour * (1.0f / kPi);
    else
      diffuseOnly_ = false;
  }
  roughAlbedo_ = min(roughAlbedo_, Vec3(1));
  for (Summand& s : std::span(lobes_, count_))
    s.share = maxComponent(s.albedo) / (s.group == LobeGroup::Rough ? rough : specular);
  if (specular > 0.0f) specularProbability_ = specular / (specular + rough);
  if (specularProbability_ < kMinProbability) specularProbability_ = 0.0f;
  reflectance_ = std::min(1.0f, maxComponent(all));
  if (reflectance_ < kMinProbability) reflectance_ = 0.0f;
}

Vec3 LobeSum::glossyBound(float maxCosine, float cosMirror) const {
  Vec3 sum;
  for (const Summand& s : lobes()) {
    if (s.group != LobeGroup::Rough || isLambert(s.lobe)) continue;
    sum += s.weight * s.coatOut *
           std::visit([&](const auto& l) { return l.bound(wo_, maxCosine, cosMirror); }, s.lobe);
  }
  return sum;
}

float LobeSum::photonCosine(const SurfacePoint& point, Vec3 normal, Vec3 wi) const {
  return shadingFactor(point, normal) * std::fabs(dot(point.ng, wi));
}

// Light must come from the shading normal's side of the surface: radiance from wi, photons from wo.
// Lobes have their own side at the other end, but for Lambert's, which leave by the geometric one.
LobeSum::Evaluated LobeSum::evaluate(const SurfacePoint& point, LobeGroup group,
                                     Transport transport, Vec3 wi) const {
  Evaluated sum;
  const bool photons = transport == Transport::Photons;
  const float ng = dot(point.ng, wi), ns = dot(point.ns, wi);
  if (ng == 0.0f || (!photons && ng * ns <= 0.0f)) return sum;
  const Vec3 local = toLocal(wi);
  for (const Summand& s : lobes()) {
    if (s.group != group) continue;
    if (const auto* lambert = std::get_if<LambertLobe>(&s.lobe)) {
      const Vec3 w{0.0f, 0.0f, photons ? ng : ns};
      const float cosine = photons ? photonCosine(point, point.ns, wi) : std::fabs(ns);
      sum.value += s.weight * lambert->value(wo_, w, transport) * cosine;
      sum.pdf += s.share * lambert->pdf(wo_, w);
      continue;
    }
    if (local.z * ng <= 0.0f) continue;
    const float cosine = photons ? photonCosine(point, frame_[2], wi) : std::fabs(local.z);
    std::visit(
        [&](const auto& l) {
          sum.value += s.weight * l.value(wo_, local, transport) * (cosine * s.coat(local.z));
          sum.pdf += s.share * l.pdf(wo_, local);
        },
        s.lobe);
  }
  return sum;
}

bool LobeSum::sample(const SurfacePoint& point, LobeGroup group, Transport transport, float pick,
                     Point2 at, BsdfSample& out) const {
  const bool photons = transport == Transport::Photons;
  if (photons && dot(point.ns, point.wo) <= 0.0f) return false;
  const Summand* chosen = nullptr;
  float rest = pick;
  for (const Summand& s : lobes()) {
    if (s.group != group) continue;
    if (chosen) rest -= chosen->share;  // not this one: the next
    chosen = &s;
    if (rest < s.share) break;
  }
  if (!chosen) return false;
  LobeSample drawn;
  const float within = std::clamp(rest / chosen->share, 0.0f, 0x1.fffffep-1f);
  if (!std::visit([&](const auto& l) { return l.sample(wo_, within, at, drawn); }, chosen->lobe))
    return false;
  out.wi = isLambert(chosen->lobe) ? Basis(photons ? point.ng : point.ns).toWorld(drawn.wi)
                                   : toWorld(drawn.wi);
  const float ng = dot(point.ng, out.wi);
  const bool crosses = drawn.wi.z < 0.0f;
  if (crosses ? ng >= 0.0f : ng <= 0.0f) return false;
  out.side = crosses ? -point.ng : point.ng;
  if (std::visit([](const auto& l) { return l.smooth(); }, chosen->lobe)) {
    out.pdf = 0.0f;
    out.weight = chosen->weight * drawn.weight * (chosen->coat(drawn.wi.z) / chosen->share);
    if (const auto* glass = std::get_if<DielectricLobe>(&chosen->lobe); glass && crosses)
      out.weight *= glass->squeezed(transport);
    if (photons)
      out.weight *= photonCosine(point, frame_[2], out.wi) / std::max(1e-6f, std::fabs(drawn.wi.z));
    return !isBlack(out.weight);
  }
  const Evaluated all = evaluate(point, group, transport, out.wi);
  if (!(all.pdf > 0.0f)) return false;
  out.pdf = all.pdf;
  out.weight = all.value * (1.0f / all.pdf);
  return !isBlack(out.weight);
}

}  // namespace bnvpl
