#include "transport/bsdf.h"

#include <algorithm>

namespace bnvpl {

static_assert(std::is_trivially_copyable_v<Bsdf> && std::is_trivially_destructible_v<Bsdf>);

float CoatAbove::through(float cosine) const {
  return 1.0f - weight * ggxAlbedo(0.04f, 1.0f, cosine, alpha);
}

void addModel(const MaterialModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  std::visit([&](const auto& m) { addLobes(m, inputs, weight, out); }, model);
}

std::optional<bool> roughEverywhere(const Material& material) {
  return std::visit([](const auto& m) { return roughEverywhere(m); }, material.model);
}

bool mayBeSpecular(const Material& material) {
  return std::visit([](const auto& m) { return mayBeSpecular(m); }, material.model);
}

bool hasSpecularLobes(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const Material& m) { return mayBeSpecular(m); });
}

bool isGlass(const Scene& scene, uint32_t material) {
  if (material == kNone) return false;
  return std::visit([&](const auto& m) { return isGlass(m, scene); },
                    scene.materials[material].model);
}

Bsdf::Bsdf(const Scene& scene, const SurfacePoint& point) : point_(point) {
  addModel(scene.materials[point.material].model, MaterialInputs(scene, point), Vec3(1), *this);
  finish();
}

Bsdf::Bsdf(const SurfacePoint& point, Vec3 albedo) : point_(point) {
  add(Vec3(1), LambertLobe{albedo});
  finish();
}

uint32_t Bsdf::frame(Vec3 shadingNormal, float turns) {
  needFrame();
  for (uint32_t f = 0; f < frameCount_; ++f) {
    if (frames_[f].ns == shadingNormal && frames_[f].turns == turns) return f;
  }
  if (frameCount_ == kMaxFrames) return 0;
  std::construct_at(&frames_[frameCount_], point_, shadingNormal, turns);
  return frameCount_++;
}

// Cosine-weighted mean over wi of the smaller transmittance of the coat, `most` at wo.
float Bsdf::meanThrough(const CoatAbove& above, float most) {
  constexpr int kSteps = 8;
  float sum = 0.0f;
  for (int i = 0; i < kSteps; ++i)
    sum += std::min(most, above.through(std::sqrt((float(i) + 0.5f) / kSteps)));
  return sum / kSteps;
}

template <typename L>
Vec3 Bsdf::meanThrough(const L& lobe, const Summand& s) const {
  const LobeFrame& local = frames_[s.frame];
  Vec3 reflected, kept;
  for (uint32_t i = 0; i < kGoldenPoints; ++i) {
    Point2 at = goldenPoint(i);
    if constexpr (std::is_same_v<L, LayeredBase>) {
      if (!lobe.transmitted) at = goldenDiskSample(i);  // it samples the cosine
    }
    LobeSample drawn;
    if (!lobe.sample(local.wo, 0.5f, at, drawn)) continue;
    const float pdf = lobe.pdf(local.wo, drawn.wi);
    if (!(pdf > 0.0f)) continue;
    const Vec3 weight =
        lobe.value(local.wo, drawn.wi, TransportMode::Radiance) * (std::fabs(drawn.wi.z) / pdf);
    const float cosine = std::fabs(dot(frames_[s.above.frame].z, local.toWorld(drawn.wi)));
    reflected += weight;
    kept += weight * std::min(s.coatOut, s.above.through(cosine));
  }
  for (size_t c = 0; c < 3; ++c) kept[c] = reflected[c] > 0.0f ? kept[c] / reflected[c] : s.coatOut;
  return kept;
}

Vec3 Bsdf::exactRoughAlbedo() const {
  if (albedoIsExact_) return roughAlbedo_;
  Vec3 sum;
  for (const Summand& s : lobes()) {
    if (s.group != LobeGroup::Rough) continue;
    sum += std::visit(
        [&](const auto& lobe) {
          const Vec3 wo = frames_[s.frame].wo;
          Vec3 albedo = s.weight;
          if constexpr (requires { lobe.exactAlbedo(wo); })
            albedo *= lobe.exactAlbedo(wo);
          else
            albedo *= lobe.albedo(wo);
          return s.above.weight > 0.0f ? albedo * meanThrough(lobe, s) : albedo;
        },
        s.lobe);
  }
  return min(sum, Vec3(1));
}

void Bsdf::finish() {
  roughAlbedo_ = min(roughAlbedo_, Vec3(1));
  for (Summand& s : std::span(lobes_, count_))
    s.share /= s.group == LobeGroup::Rough ? rough_ : specular_;
  if (specular_ > 0.0f) specularProbability_ = specular_ / (specular_ + rough_);
  if (specularProbability_ < kMinProbability) specularProbability_ = 0.0f;
  survivalProbability_ = std::min(1.0f, maxComponent(albedo_));
  if (survivalProbability_ < kMinProbability) survivalProbability_ = 0.0f;
}

std::optional<ExitantFactor> Bsdf::exitantFactor() const {
  if (diffuseOnly_) return ExitantFactor{point_.ng, point_.ns};
  const Summand* rough = nullptr;
  for (const Summand& s : lobes()) {
    if (s.group != LobeGroup::Rough) continue;
    if (rough) return {};
    rough = &s;
  }
  const auto* coated = std::get_if<CoatedBase>(&rough->lobe);
  if (!coated || rough->frame != 0 || rough->above.weight > 0.0f) return {};
  return ExitantFactor{point_.ng, point_.ns, coated->coat, coated->alpha};
}

// A diffuse base below a coat or layer looks much the same from all directions. Its albedo at
// cosine 0.5 represents all of them.
DiffusePart Bsdf::diffusePart() const {
  constexpr float kHalfWay = 0.5f;
  const Vec3 wo{std::sqrt(1.0f - kHalfWay * kHalfWay), 0.0f, kHalfWay};
  DiffusePart part{{point_.ng, point_.ns}, {}};
  for (const Summand& s : lobes()) {
    if (s.group != LobeGroup::Rough || s.frame != 0) continue;
    const float kept = s.above.weight > 0.0f ? s.above.through(kHalfWay) : 1.0f;
    std::visit(
        [&](const auto& l) {
          using L = std::decay_t<decltype(l)>;
          constexpr bool kLayered = std::is_same_v<L, LayeredBase> || std::is_same_v<L, CoatedBase>;
          if constexpr (kLayered || std::is_same_v<L, LambertLobe>)
            part.value += s.weight * l.albedo(wo) * (kept / kPi);
          part.leaving.unbent |= kLayered;
        },
        s.lobe);
  }
  return part;
}

}  // namespace bnvpl
