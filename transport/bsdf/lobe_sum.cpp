#include "transport/bsdf/lobe_sum.h"

#include <memory>
#include <type_traits>

#include "transport/bsdf/diffuse_transmission/diffuse_transmission.h"
#include "transport/bsdf/mix/mix.h"

namespace bnvpl {

static_assert(std::is_trivially_copyable_v<LobeSum> && std::is_trivially_destructible_v<LobeSum>);

namespace {

bool isLambert(const Lobe& lobe) { return std::holds_alternative<LambertLobe>(lobe); }

// Fraction of a lobe's photons that are drawn about the geometric normal where the shading normal
// differs. Lobes are evaluated in a frame bent for each camera direction, so the frame of wo alone
// would leave some of these directions without samples.
constexpr float kCosineShare = 0.25f;

// The point seen from wi, on the same side.
SurfacePoint seenFrom(const SurfacePoint& point, Vec3 wi) {
  SurfacePoint p = point;
  p.wo = wi;
  return p;
}

// Cosine-weighted mean over wi of the smaller transmittance of the coat, `most` at wo.
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
  std::construct_at(&frames_[0], point, point.ns, 0.0f);
  addModel(model, MaterialInputs(scene, point), Vec3(1), *this);
  finish();
}

uint32_t LobeSum::frame(const SurfacePoint& point, Vec3 shadingNormal, float turns) {
  for (uint32_t f = 0; f < frameCount_; ++f) {
    if (frames_[f].ns == shadingNormal && frames_[f].turns == turns) return f;
  }
  if (frameCount_ == kMaxFrames) return 0;
  std::construct_at(&frames_[frameCount_], point, shadingNormal, turns);
  return frameCount_++;
}

void LobeSum::add(Vec3 weight, const Lobe& lobe, CoatAbove above, uint32_t frame) {
  if (full()) return;
  Summand s;
  s.lobe = lobe;
  s.weight = weight;
  s.above = above;
  s.frame = frame;
  std::visit(
      [&](const auto& l) {
        s.group = l.group();
        s.albedo = weight * l.albedo(frames_[frame].wo);
      },
      lobe);
  if (above.weight > 0.0f) {
    s.coatOut = above.through(frames_[above.frame].wo.z);
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

Vec3 LobeSum::glossyBound(uint32_t frame, float maxCosine, float cosMirror) const {
  Vec3 sum;
  const Vec3 wo = frames_[frame].wo;
  for (const Summand& s : lobes()) {
    if (s.frame != frame || s.group != LobeGroup::Rough || isLambert(s.lobe)) continue;
    sum += s.weight * s.coatOut *
           std::visit([&](const auto& l) { return l.bound(wo, maxCosine, cosMirror); }, s.lobe);
  }
  return sum;
}

std::optional<RoughLeaving> LobeSum::roughLeaving(const SurfacePoint& point) const {
  if (diffuseOnly_) return RoughLeaving{point.ng, point.ns};
  const Summand* rough = nullptr;
  for (const Summand& s : lobes()) {
    if (s.group != LobeGroup::Rough) continue;
    if (rough) return {};
    rough = &s;
  }
  const auto* coated = std::get_if<CoatedBase>(&rough->lobe);
  if (!coated || rough->frame != 0 || rough->above.weight > 0.0f) return {};
  return RoughLeaving{point.ng, point.ns, coated->ior, coated->alpha};
}

// A diffuse base below a coat or layer looks much the same from all directions. Its albedo at
// cosine 0.5 represents all of them.
DiffusePart LobeSum::diffusePart(const SurfacePoint& point) const {
  constexpr float kHalfWay = 0.5f;
  const Vec3 wo{std::sqrt(1.0f - kHalfWay * kHalfWay), 0.0f, kHalfWay};
  DiffusePart part{{point.ng, point.ns, 0.0f, 0.0f, true}, {}};
  for (const Summand& s : lobes()) {
    if (s.group != LobeGroup::Rough || s.frame != 0) continue;
    const float kept = s.above.weight > 0.0f ? s.above.through(kHalfWay) : 1.0f;
    std::visit(
        [&](const auto& l) {
          using L = std::decay_t<decltype(l)>;
          if constexpr (std::is_same_v<L, LambertLobe> || std::is_same_v<L, LayeredBase> ||
                        std::is_same_v<L, CoatedBase>)
            part.value += s.weight * l.albedo(wo) * (kept / kPi);
        },
        s.lobe);
  }
  return part;
}

float LobeSum::photonCosine(const SurfacePoint& point, Vec3 normal, Vec3 wi) const {
  return shadingFactor(point, normal) * std::fabs(dot(point.ng, wi));
}

float LobeSum::coat(const Summand& s, Vec3 wi) const {
  if (!(s.above.weight > 0.0f)) return 1.0f;
  return std::min(s.coatOut, s.above.through(std::fabs(dot(frames_[s.above.frame].z, wi))));
}

bool LobeSum::lit(const SurfacePoint& point, const Summand& s, Transport transport, Vec3 wi) const {
  const bool photons = transport == Transport::Photons;
  const Vec3 from = photons ? point.wo : wi;
  const float side = photons ? 1.0f : dot(point.ng, wi);
  const auto on = [&](Vec3 ns) { return side * dot(ns, from) > 0.0f; };
  return on(frames_[s.frame].ns) &&
         (s.frame == 0 || s.group == LobeGroup::Specular || on(point.ns));
}

float LobeSum::cosineShare(const SurfacePoint& point, const Summand& s) const {
  if (frames_[s.frame].ns == point.ng) return 0.0f;
  return std::visit(
      [](const auto& l) {
        using L = std::decay_t<decltype(l)>;
        if constexpr (std::is_same_v<L, LayeredBase>)
          if (l.transmitted) return 0.0f;
        return l.smooth() || std::is_same_v<L, LambertLobe> ? 0.0f : kCosineShare;
      },
      s.lobe);
}

Vec3 LobeSum::adjointValue(const SurfacePoint& point, const Summand& s, Vec3 wi) const {
  const auto frameOf = [&](const LobeFrame& f) {
    return f.ns == point.ng ? f : LobeFrame(seenFrom(point, wi), f.ns, f.turns);
  };
  const LobeFrame frame = frameOf(frames_[s.frame]);
  const Vec3 light = frame.toLocal(point.wo);
  if (!(light.z > 0.0f)) return {};
  float kept = 1.0f;
  if (s.above.weight > 0.0f) {
    const LobeFrame coat = s.above.frame == s.frame ? frame : frameOf(frames_[s.above.frame]);
    kept = std::min(s.above.through(coat.wo.z), s.above.through(std::fabs(dot(coat.z, point.wo))));
  }
  return std::visit([&](const auto& l) { return l.value(frame.wo, light, Transport::Radiance); },
                    s.lobe) *
         (kept * photonCosine(point, frame.z, wi));
}

// Value and density of a group's lobes. Lobes other than Lambert's need wi on one side of both
// their frame's normal and the surface. Frames are bent for the camera's direction (LobeFrame): wo
// for radiance; for photons it is wi, see adjointValue().
LobeSum::Evaluated LobeSum::evaluate(const SurfacePoint& point, LobeGroup group,
                                     Transport transport, Vec3 wi) const {
  Evaluated sum;
  const bool photons = transport == Transport::Photons;
  const float ng = dot(point.ng, wi);
  if (ng == 0.0f) return sum;
  Vec3 locals[kMaxFrames];
  for (uint32_t f = 0; f < frameCount_; ++f) locals[f] = frames_[f].toLocal(wi);
  for (const Summand& s : lobes()) {
    if (s.group != group || !lit(point, s, transport, wi)) continue;
    const LobeFrame& frame = frames_[s.frame];
    if (const auto* lambert = std::get_if<LambertLobe>(&s.lobe)) {
      const float ns = dot(point.ns, wi);
      const Vec3 w{0.0f, 0.0f, photons ? ng : ns};
      const float cosine = photons ? photonCosine(point, point.ns, wi) : std::fabs(ns);
      sum.value += s.weight * lambert->value(frame.wo, w, transport) * cosine;
      sum.pdf += s.share * lambert->pdf(frame.wo, w);
      continue;
    }
    const Vec3 local = locals[s.frame];
    const bool within = local.z * ng > 0.0f;
    const bool byEye = photons && ng > 0.0f && frame.ns != point.ng;
    if (byEye) {
      sum.value += s.weight * adjointValue(point, s, wi);
      sum.pdf += s.share * cosineShare(point, s) * pdfCosineHemisphere(ng);
    }
    if (!within) continue;
    std::visit(
        [&](const auto& l) {
          if (!byEye) {
            const float cosine = photons ? photonCosine(point, frame.z, wi) : std::fabs(local.z);
            sum.value += s.weight * l.value(frame.wo, local, transport) * (cosine * coat(s, wi));
          }
          const float rest = photons ? 1.0f - cosineShare(point, s) : 1.0f;
          sum.pdf += s.share * rest * l.pdf(frame.wo, local);
        },
        s.lobe);
  }
  return sum;
}

bool LobeSum::sample(const SurfacePoint& point, LobeGroup group, Transport transport, float pick,
                     Point2 at, BsdfSample& out) const {
  const bool photons = transport == Transport::Photons;
  const Summand* chosen = nullptr;
  float rest = pick;
  for (const Summand& s : lobes()) {
    if (s.group != group) continue;
    if (chosen) rest -= chosen->share;
    chosen = &s;
    if (rest < s.share) break;
  }
  if (!chosen) return false;
  const LobeFrame& frame = frames_[chosen->frame];
  LobeSample drawn;
  float within = std::clamp(rest / chosen->share, 0.0f, 0x1.fffffep-1f);
  const float surface = photons ? cosineShare(point, *chosen) : 0.0f;
  if (within < surface) {
    drawn.wi = sampleCosineHemisphere(at.x, at.y);
    out.wi = Basis(point.ng).toWorld(drawn.wi);
  } else {
    within = std::min((within - surface) / (1.0f - surface), 0x1.fffffep-1f);
    if (!std::visit([&](const auto& l) { return l.sample(frame.wo, within, at, drawn); },
                    chosen->lobe))
      return false;
    out.wi = isLambert(chosen->lobe) ? Basis(photons ? point.ng : point.ns).toWorld(drawn.wi)
                                     : frame.toWorld(drawn.wi);
  }
  const float ng = dot(point.ng, out.wi);
  const bool crosses = drawn.wi.z < 0.0f;
  if (crosses ? ng >= 0.0f : ng <= 0.0f) return false;
  if (!lit(point, *chosen, transport, out.wi)) return false;
  out.side = crosses ? -point.ng : point.ng;
  if (std::visit([](const auto& l) { return l.smooth(); }, chosen->lobe)) {
    out.pdf = 0.0f;
    out.weight = chosen->weight * drawn.weight * (coat(*chosen, out.wi) / chosen->share);
    if (const auto* glass = std::get_if<DielectricLobe>(&chosen->lobe); glass && crosses)
      out.weight *= glass->radianceScale(transport);
    if (photons)
      out.weight *= photonCosine(point, frame.z, out.wi) / std::max(1e-6f, std::fabs(drawn.wi.z));
    return !isBlack(out.weight);
  }
  const Evaluated all = evaluate(point, group, transport, out.wi);
  if (!(all.pdf > 0.0f)) return false;
  out.pdf = all.pdf;
  out.weight = all.value * (1.0f / all.pdf);
  return !isBlack(out.weight);
}

}  // namespace bnvpl
