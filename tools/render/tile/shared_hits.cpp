#include "tools/render/tile/shared_hits.h"

namespace bnvpl {

namespace {

// How a sample and a hit see each other.
struct Link {
  float density = 0.0f;  // of one ray, 1/unit^2
  Vec3 value;            // of the radiance that leaves the hit, 1/unit^2
  bool seen = false;
};

Link linkOf(const Directions& from, const SharedHit& hit) {
  const Bsdf& bsdf = from.bsdf();
  const Vec3 way = hit.position - bsdf.point().position;
  const float squared = dot(way, way);
  if (!(squared > 0.0f)) return {};
  const float distance = std::sqrt(squared), share = hit.own.share(distance);
  if (!(share > 0.0f)) return {};
  const Vec3 wi = way * (1.0f / distance);
  const float cosine = -dot(hit.normal, wi);
  if (!(cosine > 0.0f)) return {};
  const float leaving = hit.leaving.towards(-wi);
  if (!(leaving > 0.0f)) return {};
  const float perArea = share * cosine / squared;
  Link link{from.pdf(wi) * perArea, bsdf.eval(LobeGroup::Rough, wi) * (perArea * leaving)};
  link.seen = link.density > 0.0f || !isBlack(link.value);
  return link;
}

}  // namespace

size_t shareHits(const RayScene& rays, std::span<HitSharer> group) {
  const size_t members = group.size();
  std::vector<Link> links;
  std::vector<const SharedHit*> hits;
  for (size_t i = 0; i < members; ++i) {
    for (const SharedHit& hit : group[i].hits) {
      if (isBlack(hit.radiance)) continue;
      hits.push_back(&hit);
      for (size_t k = 0; k < members; ++k) links.push_back(linkOf(*group[k].directions, hit));
    }
  }
  // Of its own hits a sample knows that it sees them.
  std::vector<Segment> segments;
  std::vector<size_t> asked;
  size_t begin = 0;
  for (size_t i = 0, h = 0; i < members; ++i) {
    for (; h < hits.size() && hits[h] >= group[i].hits.data() &&
           hits[h] < group[i].hits.data() + group[i].hits.size();
         ++h, begin += members) {
      for (size_t k = 0; k < members; ++k) {
        if (k == i || !links[begin + k].seen) continue;
        const SurfacePoint& at = group[k].directions->bsdf().point();
        const Vec3 way = hits[h]->position - at.position;
        segments.push_back({rays.offsetOrigin(at.position, dot(at.ng, way) > 0.0f ? at.ng : -at.ng),
                            rays.offsetOrigin(hits[h]->position, hits[h]->normal)});
        asked.push_back(begin + k);
      }
    }
  }
  std::vector<uint8_t> hidden(segments.size());
  rays.occluded(segments, hidden);
  for (size_t s = 0; s < asked.size(); ++s)
    if (hidden[s]) links[asked[s]].seen = false;
  for (size_t h = 0; h < hits.size(); ++h) {
    const Link* of = &links[h * members];
    float density = 0.0f;
    for (size_t k = 0; k < members; ++k)
      if (of[k].seen) density += static_cast<float>(group[k].rays) * of[k].density;
    if (!(density > 0.0f)) continue;
    const Vec3 each = hits[h]->radiance * (1.0f / density);
    for (size_t k = 0; k < members; ++k) {
      if (!of[k].seen) continue;
      const Vec3 light = of[k].value * each;
      group[k].brought += light, group[k].squares += light * light;
    }
  }
  return segments.size();
}

}  // namespace bnvpl
