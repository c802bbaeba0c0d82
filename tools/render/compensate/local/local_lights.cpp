#include "tools/render/compensate/local/local_lights.h"

#include <algorithm>
#include <array>

#include "core/sampling.h"
#include "transport/direct_light/direct_light.h"
#include "transport/virtual_light/spherical/spherical_transfer.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Maximal number of vertices of the path that finds the light of a hit.
constexpr unsigned kMaxVertices = 16;
// VPLs drawn and shadow rays to lights at the hit, which serve the whole block, and at later ones.
constexpr unsigned kFirstDraws = 8, kFirstLightRays = 4, kLaterDraws = 2, kLaterLightRays = 1;
constexpr float kUniformPdf = 1.0f / (2.0f * kPi);  // over a hemisphere

}  // namespace

LocalLights::LocalLights(const Accelerator& accel, const VertexLights& vertexLights,
                         const UncoveredShare& share, const LocalLightOptions& options,
                         std::span<const Bsdf* const> receivers, uint64_t key, uint32_t groups)
    : accel_(accel),
      vertexLights_(vertexLights),
      share_(share),
      options_(options),
      receivers_(receivers),
      groups_(groups) {
  const size_t count = receivers.size();
  shooters_ = std::min<size_t>(options.shooters, count);
  for (size_t k = 0; k < shooters_; ++k) {  // one from each of as many parts of the block
    const double place = (double(k) + double{toUnitFloat(random64(key, k, 0))}) / double(shooters_);
    const auto drawn = std::min(count - 1, static_cast<size_t>(place * double(count)));
    shootFrom(*receivers[drawn], random64(key, k, 1));
  }
}

void LocalLights::shootFrom(const Bsdf& shooter, uint64_t key) {
  std::array<Ray, Accelerator::kBatch> batch;
  std::array<SurfacePoint, Accelerator::kBatch> hits;
  std::vector<Rng> numbers;
  for (uint32_t begin = 0; begin < options_.rays; begin += Accelerator::kBatch) {
    const uint32_t end = std::min<uint32_t>(options_.rays, begin + Accelerator::kBatch);
    numbers.clear();
    for (uint32_t k = begin; k < end; ++k) {
      Rng rng = Rng::stratified(key, k);
      BsdfSample sample;
      if (!sampleNextRay(accel_, shooter, LobeGroup::Rough, TransportMode::Radiance, rng, sample,
                         batch[numbers.size()]))
        continue;
      numbers.push_back(rng);
    }
    raysSent_ += numbers.size();
    accel_.closestHits({batch.data(), numbers.size()}, hits);
    for (size_t k = 0; k < numbers.size(); ++k)
      if (hits[k].triangle != kNone) addLight(hits[k], numbers[k]);
  }
}

// Makes a local light of a hit, with the probability q.
void LocalLights::addLight(const SurfacePoint& hit, Rng& rng) {
  float most = 0.0f;
  for (const Bsdf* receiver : receivers_)
    most = std::max(most, share_.at(length(hit.position - receiver->point().position)));
  if (!(rng.next() < most)) return;
  // Expected rays per unit area of the surface, and of the disk that faces them: the light's sphere
  // shows that disk, of a density that is at least that of uniform directions.
  float density = 0.0f, facing = 0.0f;
  const float raysEach = static_cast<float>(options_.rays) * static_cast<float>(shooters_) /
                         static_cast<float>(receivers_.size());
  for (const Bsdf* receiver : receivers_) {
    const Vec3 way = hit.position - receiver->point().position;
    const float d2 = lengthSquared(way);
    if (!(d2 > 0.0f)) continue;
    const Vec3 direction = way * (1.0f / std::sqrt(d2));
    const float cosine = -dot(hit.ng, direction);
    if (!(cosine > 0.0f)) continue;
    const float pdf = receiver->pdf(LobeGroup::Rough, direction);
    const float perDisk = raysEach / d2;
    density += pdf * cosine * perDisk;
    facing += std::max(pdf, kUniformPdf) * perDisk;
  }
  if (!(density > 0.0f)) return;
  Light light{hit.position, hit.ng};
  light.area = 1.0f / (most * density);
  light.radius2 = options_.radius * options_.radius / (kPi * facing);
  const size_t before = byGroup_.size();
  byGroup_.resize(before + groups_);
  findRadiance(hit, rng, light, std::span(byGroup_).subspan(before));
  if (isBlack(light.radiance)) {
    byGroup_.resize(before);
  } else {
    lights_.push_back(light);
  }
}

// Follows a path from the hit, lit at each vertex by lights and bounded VPLs. It goes on with the
// probability of the share that these leave out, as in kollig-keller.
void LocalLights::findRadiance(const SurfacePoint& hit, Rng& rng, Light& light,
                               std::span<Vec3> groups) {
  SurfacePoint point = hit;
  Vec3 throughput(1.0f);
  for (unsigned vertices = 1;; ++vertices) {
    const Bsdf bsdf(accel_.scene(), point);
    if (!bsdf.hasRough()) return;
    const bool first = vertices == 1;
    if (first) {
      light.leaving = bsdf.exitantFactor();
      if (light.leaving) light.towardsShooter = light.leaving->towards(point.wo);
    }
    const unsigned lightRays = first ? kFirstLightRays : kLaterLightRays;
    LearnedStrata strata;
    if (vertexLights_.spatialLights)
      strata = vertexLights_.spatialLights->at(point.position, point.ng);
    const LightGroupSink sink = sinkTo(groups).times(throughput);
    const LightNumbers numbers =
        strata.all && lightRays > 1 ? LightNumbers::sequence(rng) : LightNumbers(rng);
    const LightSampling sampling{
        {strata.all ? &strata : nullptr, lightRays}, LightChoice::One, {}, sink};
    light.radiance += throughput * directLight(accel_, vertexLights_.lights, Reflected{bsdf},
                                               sampling, NoRays{}, numbers);
    const Gathered vpls = vertexLights_.vpls(bsdf, first ? kFirstDraws : kLaterDraws, rng, sink);
    light.radiance += throughput * vpls.radiance;
    light.clamped += throughput * vpls.clamped;
    shadowRays_ += vpls.shadowRays;
    BsdfSample sample;
    Ray next;
    if (vertices == kMaxVertices ||
        !sampleNextRay(accel_, bsdf, LobeGroup::Rough, TransportMode::Radiance, rng, sample, next))
      return;
    SurfacePoint found;
    ++raysSent_;
    if (!accel_.closestHit(next.origin, next.direction, found)) return;
    if (!(rng.next() < share_.at(found.distance))) return;
    throughput *= sample.weight;
    point = found;
  }
}

Gathered LocalLights::at(const Bsdf& receiver, uint64_t key, const LightGroupSink& groups) const {
  Gathered out;
  for (size_t i = 0; i < lights_.size(); ++i) {
    const Light& light = lights_[i];
    const Vec3 way = light.position - receiver.point().position;
    const float d2 = lengthSquared(way);
    if (!(d2 > 0.0f) || !(dot(light.normal, way) < 0.0f)) continue;
    const float distance = std::sqrt(d2), share = share_.at(distance);
    if (!(share > 0.0f)) continue;
    const Vec3 direction = way * (1.0f / distance);
    float factor = share * light.area;
    if (light.towardsShooter > 0.0f)
      factor *= light.leaving->towards(-direction) / light.towardsShooter;
    ++out.cut;
    Vec3 transfer;
    if (light.radius2 > 0.0f) {
      transfer =
          sphericalTransfer({way, light.normal, light.radius2}, receiver, random64(key, i, 0))
              .value *
          factor;
    } else {
      transfer = receiver.eval(LobeGroup::Rough, direction) *
                 (-dot(light.normal, direction) / d2 * factor);
    }
    out.radiance += transfer * light.radiance;
    out.clamped += transfer * light.clamped;
    for (uint32_t g = 0; groups && g < groups_; ++g)
      groups.add(g, transfer * byGroup_[i * groups_ + g]);
  }
  return out;
}

}  // namespace bnvpl
