// LightSlice (Ou & Pellacini 2011): the points that the camera sees are divided into slices; a row
// of the many-light matrix is taken for each; the lights are clustered once by all rows, and then,
// for each slice, further by the rows of the slices around it.
#include <algorithm>
#include <array>
#include <memory>
#include <numeric>

#include "core/parallel.h"
#include "tools/common/streams.h"
#include "tools/render/gather/gather.h"
#include "tools/render/gather/lightslice/column_clusters.h"
#include "tools/render/gather/lightslice/slices.h"

namespace bnvpl::methods::gather::lightslice {

namespace {

constexpr std::array kOptions{
    countOption("slices", "300", 0x1p20, "", "groups of neighbouring points"),
    countOption("columns", "400", 0x1p20, "clusters", "clusters of VPLs for each slice"),
    countOption("neighbour-slices", "16", 1024, "", "whose rows refine the clusters of a slice")};
// Of the clusters of a slice, how many are found once for all of them.
constexpr double kCommonShare = 1.0 / 3.0;

// What every VPL brings to the point, visibility included, summed over the channels.
std::vector<float> rowOf(const GatherInputs& in, const SurfacePoint& point) {
  const Bsdf bsdf(in.rays.scene(), point);
  const Vec3 from = in.rays.offsetOrigin(point.position, point.ng);
  std::vector<float> row(in.vpls.size(), 0.0f);
  Coupling c;
  for (uint32_t i = 0; i < row.size(); ++i) {
    if (!couple(in.vpls, i, bsdf, c) || in.rays.occluded(from, in.vpls.position[i])) continue;
    const Vec3 light = c.transfer * in.vpls.intensity[i];
    row[i] = light.x + light.y + light.z;
  }
  return row;
}

Columns columnsOf(const std::vector<std::vector<float>>& rows, std::span<const uint32_t> chosen) {
  Columns columns;
  columns.rows = chosen.size();
  const size_t lights = rows.empty() ? 0 : rows.front().size();
  columns.value.resize(lights * chosen.size());
  for (size_t r = 0; r < chosen.size(); ++r) {
    for (size_t i = 0; i < lights; ++i) columns.value[i * chosen.size() + r] = rows[chosen[r]][i];
  }
  columns.measure();
  return columns;
}

// The VPLs that light the points of each slice, with their weights.
struct Plan {
  Slices slices;
  std::vector<std::vector<ColumnDraw>> ofSlice;
};

std::shared_ptr<const Plan> makePlan(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<Plan>();
  const FilmPoints film = in.film();
  const uint64_t key = streamKey(in.seed, Stream::LightTree) + 1;
  plan->slices = Slices(film.points, options.whole("slices"), key);
  const std::span<const SurfacePoint> representatives = plan->slices.representatives();
  if (in.vpls.size() == 0 || representatives.empty()) return plan;

  std::vector<std::vector<float>> rows(representatives.size());
  parallelFor(rows.size(), 1, [&](size_t s) { rows[s] = rowOf(in, representatives[s]); });

  std::vector<uint32_t> all(rows.size()), lights(in.vpls.size());
  std::iota(all.begin(), all.end(), 0u);
  std::iota(lights.begin(), lights.end(), 0u);
  const auto columns = static_cast<size_t>(options.whole("columns"));
  const Columns whole = columnsOf(rows, all);
  std::vector<ColumnCluster> common{clusterOf(lights, whole)};
  Rng rng(key, 0);
  refine(common, std::max<size_t>(1, static_cast<size_t>(double(columns) * kCommonShare)), whole,
         rng);

  plan->ofSlice.resize(rows.size());
  parallelFor(rows.size(), 1, [&](size_t s) {
    const Columns local =
        columnsOf(rows, plan->slices.nearest(s, options.whole("neighbour-slices")));
    std::vector<ColumnCluster> clusters;
    for (const ColumnCluster& c : common) clusters.push_back(clusterOf(c.lights, local));
    Rng own(key, s + 1);
    refine(clusters, columns, local, own);
    for (const ColumnCluster& c : clusters) {
      const ColumnDraw draw = drawFrom(c, local, own);
      if (draw.weight > 0.0f) plan->ofSlice[s].push_back(draw);
    }
  });
  return plan;
}

Gathered gatherPoint(const RayScene& rays, const VplLights& vpls, const Plan& plan,
                     const Bsdf& bsdf) {
  Gathered out;
  if (plan.ofSlice.empty()) return out;
  const SurfacePoint& point = bsdf.point();
  const Vec3 from = rays.offsetOrigin(point.position, point.ng);
  const std::vector<ColumnDraw>& draws = plan.ofSlice[plan.slices.sliceOf(point)];
  Coupling c;
  for (const ColumnDraw& draw : draws) {
    if (!couple(vpls, draw.light, bsdf, c)) continue;
    ++out.shadowRays;
    if (rays.occluded(from, vpls.position[draw.light])) continue;
    const Vec3 light = c.transfer * vpls.intensity[draw.light] * draw.weight;
    out.radiance += light;
    out.clamped += light * c.clamped;
  }
  out.cut = static_cast<uint32_t>(draws.size());
  return out;
}

Gather make(const GatherInputs& in, const Values& options) {
  return gatherEach([&rays = in.rays, &vpls = in.vpls, plan = makePlan(in, options)](
                        const Bsdf& bsdf) { return gatherPoint(rays, vpls, *plan, bsdf); });
}

}  // namespace

extern const GatherMethod method;
const GatherMethod method{
    "lightslice", "VPLs clustered for each slice of what the camera sees, by rows of their matrix",
    kOptions, make};

}  // namespace bnvpl::methods::gather::lightslice
