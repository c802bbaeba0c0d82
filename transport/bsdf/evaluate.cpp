// Values, densities and samples of a sum of lobes.
#include "transport/bsdf.h"

namespace bnvpl {

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

}  // namespace

Vec3 Bsdf::glossyBound(uint32_t frame, float maxCosine, float cosMirror) const {
  Vec3 sum;
  const Vec3 wo = frames_[frame].wo;
  for (const Summand& s : lobes()) {
    if (s.frame != frame || s.group != LobeGroup::Rough || isLambert(s.lobe)) continue;
    sum += s.weight * s.coatOut *
           std::visit([&](const auto& l) { return l.bound(wo, maxCosine, cosMirror); }, s.lobe);
  }
  return sum;
}

float Bsdf::photonCosine(Vec3 normal, Vec3 wi) const {
  return shadingFactor(point_, normal) * std::fabs(dot(point_.ng, wi));
}

float Bsdf::coat(const Summand& s, Vec3 wi) const {
  if (!(s.above.weight > 0.0f)) return 1.0f;
  return std::min(s.coatOut, s.above.through(std::fabs(dot(frames_[s.above.frame].z, wi))));
}

inline bool Bsdf::lit(const Summand& s, TransportMode transport, Vec3 wi) const {
  const bool photons = transport == TransportMode::Importance;
  const Vec3 from = photons ? point_.wo : wi;
  const float side = photons ? 1.0f : dot(point_.ng, wi);
  const auto on = [&](Vec3 ns) { return side * dot(ns, from) > 0.0f; };
  return on(frames_[s.frame].ns) &&
         (s.frame == 0 || s.group == LobeGroup::Specular || on(point_.ns));
}

float Bsdf::cosineShare(const Summand& s) const {
  if (frames_[s.frame].ns == point_.ng || s.smooth || isLambert(s.lobe)) return 0.0f;
  const auto* layered = std::get_if<LayeredBase>(&s.lobe);
  return layered && layered->transmitted ? 0.0f : kCosineShare;
}

Vec3 Bsdf::adjointValue(const Summand& s, Vec3 wi) const {
  const auto frameOf = [&](const LobeFrame& f) {
    return f.ns == point_.ng ? f : LobeFrame(seenFrom(point_, wi), f.ns, f.turns);
  };
  const LobeFrame frame = frameOf(frames_[s.frame]);
  const Vec3 light = frame.toLocal(point_.wo);
  if (!(light.z > 0.0f)) return {};
  float kept = 1.0f;
  if (s.above.weight > 0.0f) {
    const LobeFrame coat = s.above.frame == s.frame ? frame : frameOf(frames_[s.above.frame]);
    const auto through = [&](Vec3 w) { return s.above.through(std::fabs(dot(coat.z, w))); };
    kept = std::min(through(wi), through(point_.wo));
  }
  return std::visit(
             [&](const auto& l) { return l.value(frame.wo, light, TransportMode::Radiance); },
             s.lobe) *
         (kept * photonCosine(frame.z, wi));
}

// Lambert's law, the rough group of most surfaces, without a loop over lobes. Photons are drawn by
// the geometric cosine, so that their weight is the albedo times the shading factor.
Bsdf::Evaluated Bsdf::evaluateDiffuse(TransportMode transport, Vec3 wi) const {
  const float ng = dot(point_.ng, wi), ns = dot(point_.ns, wi);
  if (!(ng > 0.0f)) return {};
  if (transport == TransportMode::Importance) {
    const float cosine = photonShadingFactor() * ng;
    return cosine > 0.0f ? Evaluated{diffuseValue_ * cosine, pdfCosineHemisphere(ng)} : Evaluated{};
  }
  return ns > 0.0f ? Evaluated{diffuseValue_ * ns, pdfCosineHemisphere(ns)} : Evaluated{};
}

bool Bsdf::sampleDiffuse(TransportMode transport, Point2 at, BsdfSample& out) const {
  const bool photons = transport == TransportMode::Importance;
  const Vec3 axis = photons ? point_.ng : point_.ns;
  out.wi = Frame(axis).toWorld(sampleCosineHemisphere(at.x, at.y));
  out.pdf = pdfCosineHemisphere(dot(axis, out.wi));
  out.weight = roughAlbedo_ * (photons ? photonShadingFactor() : 1.0f);
  out.side = point_.ng;
  return dot(point_.ng, out.wi) > 0.0f && out.pdf > 0.0f && !isBlack(out.weight);
}

// Value and density of a group's lobes. Lobes other than Lambert's need wi on one side of both
// their frame's normal and the surface. Frames are bent for the camera's direction (LobeFrame): wo
// for radiance; for photons it is wi, see adjointValue().
template <TransportMode transport>
Bsdf::Evaluated Bsdf::evaluate(LobeGroup group, Vec3 wi, Terms terms) const {
  if (group == LobeGroup::Rough && diffuseOnly_) return evaluateDiffuse(transport, wi);
  Evaluated sum;
  constexpr bool photons = transport == TransportMode::Importance;
  const float ng = dot(point_.ng, wi);
  if (ng == 0.0f) return sum;
  Vec3 locals[kMaxFrames];
  for (uint32_t f = 0; f < frameCount_; ++f) locals[f] = frames_[f].toLocal(wi);
  for (const Summand& s : lobes()) {
    if (s.group != group || !lit(s, transport, wi)) continue;
    const LobeFrame& frame = frames_[s.frame];
    if (const auto* lambert = std::get_if<LambertLobe>(&s.lobe)) {
      const float ns = dot(point_.ns, wi);
      const Vec3 w{0.0f, 0.0f, photons ? ng : ns};
      const float cosine = photons ? photonCosine(point_.ns, wi) : std::fabs(ns);
      sum.value += s.weight * lambert->value(frame.wo, w, transport) * cosine;
      sum.pdf += s.share * lambert->pdf(frame.wo, w);
      continue;
    }
    const Vec3 local = locals[s.frame];
    const bool within = local.z * ng > 0.0f;
    const bool bentForCamera = photons && ng > 0.0f && frame.ns != point_.ng;
    if (bentForCamera) {
      sum.value += s.weight * adjointValue(s, wi);
      sum.pdf += s.share * cosineShare(s) * pdfCosineHemisphere(ng);
    }
    if (!within) continue;
    std::visit(
        [&](const auto& l) {
          if (!bentForCamera && terms != Terms::OnlyPdf) {
            const float cosine = photons ? photonCosine(frame.z, wi) : std::fabs(local.z);
            sum.value += s.weight * l.value(frame.wo, local, transport) * (cosine * coat(s, wi));
          }
          if (terms == Terms::OnlyValue) return;
          const float rest = photons ? 1.0f - cosineShare(s) : 1.0f;
          sum.pdf += s.share * rest * l.pdf(frame.wo, local);
        },
        s.lobe);
  }
  return sum;
}

template Bsdf::Evaluated Bsdf::evaluate<TransportMode::Radiance>(LobeGroup, Vec3, Terms) const;

bool Bsdf::sample(LobeGroup group, TransportMode transport, Rng& rng, BsdfSample& out) const {
  const float pick = rng.next();
  return sample(group, transport, pick, rng.nextPoint(), out);
}

bool Bsdf::sample(LobeGroup group, TransportMode transport, float pick, Point2 at,
                  BsdfSample& out) const {
  if (group == LobeGroup::Rough && diffuseOnly_) return sampleDiffuse(transport, at, out);
  const bool photons = transport == TransportMode::Importance;
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
  const float surface = photons ? cosineShare(*chosen) : 0.0f;
  if (within < surface) {
    drawn.wi = sampleCosineHemisphere(at.x, at.y);
    out.wi = Frame(point_.ng).toWorld(drawn.wi);
  } else {
    within = std::min((within - surface) / (1.0f - surface), 0x1.fffffep-1f);
    if (!std::visit([&](const auto& l) { return l.sample(frame.wo, within, at, drawn); },
                    chosen->lobe))
      return false;
    out.wi = isLambert(chosen->lobe) ? Frame(photons ? point_.ng : point_.ns).toWorld(drawn.wi)
                                     : frame.toWorld(drawn.wi);
  }
  const float ng = dot(point_.ng, out.wi);
  const bool crosses = drawn.wi.z < 0.0f;
  if (crosses ? ng >= 0.0f : ng <= 0.0f) return false;
  // Light that goes straight on meets no side of the surface, wherever the shading normal points.
  const bool straight = crosses && chosen->smooth && dot(out.wi, point_.wo) < -0.999999f;
  if (!straight && !lit(*chosen, transport, out.wi)) return false;
  out.side = crosses ? -point_.ng : point_.ng;
  if (chosen->smooth) {
    out.pdf = 0.0f;
    out.weight = chosen->weight * drawn.weight * (coat(*chosen, out.wi) / chosen->share);
    if (const auto* glass = std::get_if<DielectricLobe>(&chosen->lobe); glass && crosses)
      out.weight *= glass->radianceScale(transport);
    if (photons)
      out.weight *= photonCosine(frame.z, out.wi) / std::max(1e-6f, std::fabs(drawn.wi.z));
    return !isBlack(out.weight);
  }
  const Evaluated all = photons ? evaluate<TransportMode::Importance>(group, out.wi, Terms::Both)
                                : evaluate<TransportMode::Radiance>(group, out.wi, Terms::Both);
  if (!(all.pdf > 0.0f)) return false;
  out.pdf = all.pdf;
  out.weight = all.value * (1.0f / all.pdf);
  return !isBlack(out.weight);
}

}  // namespace bnvpl
