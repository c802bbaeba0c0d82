#include "tools/render/tile/reuse/path_reuse.h"

namespace bnvpl {

namespace {

// Connection of a sample with a vertex.
struct Connection {
  float density = 0.0f;  // p_k(y) without V: density of one ray, 1/unit^2
  Vec3 value;            // contribution per radiance that leaves the vertex, 1/unit^2
  bool visible = false;  // V
};

Connection connect(const Directions& from, const ReusedVertex& vertex) {
  const Bsdf& bsdf = from.bsdf();
  const Vec3 way = vertex.position - bsdf.point().position;
  const float squared = dot(way, way);
  if (!(squared > 0.0f)) return {};
  const float distance = std::sqrt(squared), share = vertex.uncovered.at(distance);
  if (!(share > 0.0f)) return {};
  const Vec3 wi = way * (1.0f / distance);
  const float cosine = -dot(vertex.normal, wi);
  if (!(cosine > 0.0f)) return {};
  const float leaving = vertex.leaving.towards(-wi);
  if (!(leaving > 0.0f)) return {};
  const float perArea = share * cosine / squared;
  Connection out{from.pdf(wi) * perArea, bsdf.eval(LobeGroup::Rough, wi) * (perArea * leaving)};
  // Directions::sample() rejects directions without value, so that they have no density either.
  out.visible = !isBlack(out.value);
  return out;
}

// The vertices of a group, and for each of them the connections to all samples.
struct Connections {
  size_t samples = 0;
  std::vector<const ReusedVertex*> vertices;
  std::vector<size_t> foundBy;  // the sample whose ray found the vertex
  std::vector<const Vec3*> byGroup;  // radiance by light group
  std::vector<Connection> all;  // vertex by vertex

  Connections(std::span<const ReusingSample> group, uint32_t lightGroups) : samples(group.size()) {
    for (size_t i = 0; i < samples; ++i) {
      for (const ReusedVertex& vertex : group[i].vertices) {
        if (isBlack(vertex.radiance) || !isFinite(vertex.radiance)) continue;
        vertices.push_back(&vertex);
        foundBy.push_back(i);
        byGroup.push_back(group[i].verticesByLightGroup +
                          lightGroups * static_cast<size_t>(&vertex - group[i].vertices.data()));
        for (const ReusingSample& sample : group)
          all.push_back(connect(*sample.directions, vertex));
      }
    }
  }
  Connection& at(size_t vertex, size_t sample) { return all[vertex * samples + sample]; }

  // Traces shadow rays to all vertices except a sample's own, which its ray has reached. Returns
  // their number.
  size_t testVisibility(const Accelerator& accel, std::span<const ReusingSample> group) {
    std::vector<Segment> segments;
    std::vector<Connection*> tested;
    for (size_t v = 0; v < vertices.size(); ++v) {
      for (size_t k = 0; k < samples; ++k) {
        if (k == foundBy[v] || !at(v, k).visible) continue;
        const SurfacePoint& point = group[k].directions->bsdf().point();
        const Vec3 way = vertices[v]->position - point.position;
        const Vec3 side = dot(point.ng, way) > 0.0f ? point.ng : -point.ng;
        segments.push_back({accel.offsetOrigin(point.position, side),
                            accel.offsetOrigin(vertices[v]->position, vertices[v]->normal)});
        tested.push_back(&at(v, k));
      }
    }
    std::vector<uint8_t> hidden(segments.size());
    accel.occluded(segments, hidden);
    for (size_t s = 0; s < tested.size(); ++s)
      if (hidden[s]) tested[s]->visible = false;
    return segments.size();
  }
};

}  // namespace

size_t reuseVertices(const Accelerator& accel, std::span<ReusingSample> group,
                     uint32_t lightGroups) {
  Connections connections(group, lightGroups);
  const size_t shadowRays = connections.testVisibility(accel, group);
  for (size_t v = 0; v < connections.vertices.size(); ++v) {
    float density = 0.0f;  // sum over k of n_k p_k(y)
    for (size_t k = 0; k < group.size(); ++k) {
      const Connection& c = connections.at(v, k);
      if (c.visible) density += static_cast<float>(group[k].rays) * c.density;
    }
    if (!(density > 0.0f)) continue;
    const Vec3 weighted = connections.vertices[v]->radiance * (1.0f / density);
    for (size_t k = 0; k < group.size(); ++k) {
      const Connection& c = connections.at(v, k);
      if (!c.visible) continue;
      const Vec3 light = c.value * weighted;
      group[k].radiance += light, group[k].squares += light * light;
      for (uint32_t g = 0; g < lightGroups; ++g)
        group[k].radianceByLightGroup[g] += c.value * connections.byGroup[v][g] * (1.0f / density);
    }
  }
  return shadowRays;
}

}  // namespace bnvpl
