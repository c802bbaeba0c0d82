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

// Equal parts of at most kMaxRows receivers: work and memory grow with the square of their number.
std::vector<std::span<const uint32_t>> partsOf(std::span<const uint32_t> receivers) {
  constexpr size_t kMaxRows = 1024;
  const size_t count = (receivers.size() + kMaxRows - 1) / kMaxRows;
  std::vector<std::span<const uint32_t>> parts;
  for (size_t k = 0; k < count; ++k) {
    const size_t begin = k * receivers.size() / count, end = (k + 1) * receivers.size() / count;
    parts.push_back(receivers.subspan(begin, end - begin));
  }
  return parts;
}

Gather make(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<const SlicePlan>(makeSlicePlan(in, options));
  const Complete complete = options.meet(valueIs(kCompletionOption, "columns"))
                                ? completeFromColumns
                                : completeBySeparation;
  return {.tile =
              [in, plan, complete, share = options[kShareOption]](const TileReceivers& tile,
                                                                  std::span<Gathered> out) {
                std::ranges::fill(out, Gathered{});
                if (plan->draws.empty()) return;
                std::map<size_t, std::vector<uint32_t>> slices;
                for (uint32_t i = 0; i < out.size(); ++i)
                  if (tile.bsdf[i]) slices[plan->sliceOf(tile.bsdf[i]->point())].push_back(i);
                for (const auto& [slice, receivers] : slices) {
                  const std::span<const VplDraw> turn =
                      plan->draws[slice].of(tile, tile.firstSample);
                  for (const std::span<const uint32_t> part : partsOf(receivers)) {
                    SliceMatrix matrix(in, tile, {part.begin(), part.end()}, out);
                    complete(
                        matrix, matrix.byBrightness(turn), share,
                        random64(tile.key, uint64_t{slice} << 32 | part.front(), kDimMatrixPart));
                  }
                }
              },
          .wholePixels = true,
          .filmCounts = entriesOf(plan->rows, in.vpls.size())};
}

}  // namespace

extern const GatherMethod method{
    .name = "matrix-completion",
    .summary = "few shadow rays of each slice's VPLs; the others completed from known columns",
    .options = kOptions,
    .make = make,
    .counters = kCounters,
    .sharesDraws = true};

}  // namespace bnvpl::methods::gather::matrix_completion
