// LightSlice (Ou & Pellacini 2011): the visible points are divided into slices, and a row of the
// many-light matrix is evaluated for each. The VPLs are clustered once by all rows; then each slice
// refines the clusters by the rows of the slices around it.
#include <memory>

#include "tools/render/gather/matrix_slices.h"

namespace bnvpl::methods::gather::lightslice {

namespace {

constexpr auto kOptions = optionTable(kSlicesOption, kColumnsOption, kNeighbourSlicesOption);

Gather make(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<const SlicePlan>(makeSlicePlan(in, options));
  double clusters = 0.0;
  for (const ClusterDraws& slice : plan->draws) clusters += double(slice.clusters());
  std::vector<FilmCount> filmCounts = entriesOf(plan->rows, in.vpls.size());
  filmCounts.push_back({"slice_clusters", "clusters of a slice, on average",
                        plan->draws.empty() ? 0.0 : clusters / double(plan->draws.size())});
  return {.tile =
              [in, plan](const TileReceivers& tile, std::span<Gathered> out) {
                for (size_t i = 0; i < out.size(); ++i) {
                  out[i] = {};
                  if (!tile.bsdf[i] || plan->draws.empty()) continue;
                  out[i] = plan->draws[plan->sliceOf(tile.bsdf[i]->point())].gather(in, tile, i);
                }
              },
          .filmCounts = std::move(filmCounts)};
}

}  // namespace

extern const GatherMethod method{
    .name = "lightslice",
    .summary = "VPLs clustered for each slice of the visible points, by rows of their matrix",
    .options = kOptions,
    .make = make,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::lightslice
