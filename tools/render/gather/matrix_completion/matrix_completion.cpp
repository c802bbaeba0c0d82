// Matrix completion (Huo et al. 2015, 2016): the visibility of a slice's VPLs is sampled in a few
// entries of each column, and completed in the others.
#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include "tools/render/gather/matrix_completion/slice_matrix.h"
#include "tools/render/gather/matrix_slices.h"

namespace bnvpl::methods::gather::matrix_completion {

namespace {

constexpr auto kShareOption =
    realOption("entry-share", "0.1", 0.001, 1, "share of a column's entries",
               "shadow rays by which a VPL's visibility in a tile is completed; 1: every ray");
constexpr auto kCompletionOption =
    choiceOption("completion", "columns", "columns|separation",
                 "from columns known in full (2016), or predicted and made of low rank (2015)");
constexpr auto kOptions = optionTable(kShareOption, kCompletionOption, kSlicesOption,
                                      kColumnsOption, kNeighbourSlicesOption);
constexpr std::array kCounters{
    Counter{"completedentries", "completed entries",
            "VPLs whose visibility is completed instead of traced"},
    Counter{"fullcolumns", "full columns", "VPLs that every sample of the tile's slice traces"}};

Gather make(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<const SlicePlan>(makeSlicePlan(in, options));
  const Complete complete =
      options[kCompletionOption] == "columns" ? completeFromColumns : completeBySeparation;
  return {.tile =
              [in, plan, complete, share = options[kShareOption]](const TileReceivers& tile,
                                                                  std::span<Gathered> out) {
                std::ranges::fill(out, Gathered{});
                if (plan->draws.empty()) return;
                std::map<size_t, std::vector<uint32_t>> slices;
                for (uint32_t i = 0; i < out.size(); ++i)
                  if (tile.bsdf[i]) slices[plan->sliceOf(tile.bsdf[i]->point())].push_back(i);
                for (auto& [slice, receivers] : slices) {
                  SliceMatrix matrix(in, tile, std::move(receivers), out);
                  const auto draws =
                      matrix.byBrightness(plan->draws[slice].of(tile, tile.firstSample));
                  complete(matrix, draws, share, random64(tile.key, slice, 0));
                }
              },
          .wholePixels = true,
          .planned = entriesOf(plan->slices.size(), in.vpls.size())};
}

}  // namespace

extern const GatherMethod method;
const GatherMethod method{
    .name = "matrix-completion",
    .summary = "few shadow rays of each slice's VPLs; the others completed from known columns",
    .options = kOptions,
    .make = make,
    .counters = kCounters};

}  // namespace bnvpl::methods::gather::matrix_completion
