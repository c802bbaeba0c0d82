// Matrix completion (Huo et al. 2015, 2016): the visibility of a slice's VPLs is sampled in a few
// entries of each column, and completed from the columns that are known in full.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "tools/render/gather/matrix_completion/column_basis.h"
#include "tools/render/gather/matrix_slices.h"
#include "tools/render/gather/shadow_test.h"

namespace bnvpl::methods::gather::matrix_completion {

namespace {

constexpr auto kShareOption =
    realOption("entry-share", "0.1", 0.001, 1, "share of a column's entries",
               "shadow rays by which a VPL's visibility in a tile is completed; 1: every ray");
constexpr auto kOptions =
    optionTable(kShareOption, kSlicesOption, kColumnsOption, kNeighbourSlicesOption);
constexpr std::array kCounters{
    Counter{"completedentries", "completed entries",
            "VPLs whose visibility is completed instead of traced"},
    Counter{"fullcolumns", "full columns", "VPLs that every sample of the tile's slice traces"}};
constexpr size_t kMinEntries = 8;    // sampled in each column
constexpr double kTolerance = 1e-3;  // largest error of the visibility of an accepted entry

// The receivers of a tile in one slice, and the matrix of their VPLs.
class SliceMatrix {
 public:
  SliceMatrix(const GatherInputs& in, const TileReceivers& tile, std::vector<uint32_t> receivers,
              double share, std::span<Gathered> out)
      : in_(in),
        tile_(tile),
        receivers_(std::move(receivers)),
        share_(share),
        out_(out),
        basis_(receivers_.size()),
        transfer_(receivers_.size()) {
    for (const uint32_t i : receivers_) {
      const SurfacePoint& p = tile_.bsdf[i]->point();
      from_.push_back(in_.accel.offsetOrigin(p.position, p.ng));
    }
  }

  // The draws by falling light at a few of the receivers, without visibility.
  std::vector<VplDraw> byBrightness(std::span<const VplDraw> draws) const {
    constexpr size_t kReceivers = 8;
    const size_t step = std::max<size_t>(1, receivers_.size() / kReceivers);
    std::vector<std::pair<float, VplDraw>> order;
    for (const VplDraw& d : draws) {
      float light = 0.0f;
      VplTransfer t;
      for (size_t r = 0; r < receivers_.size(); r += step) {
        if (unoccludedTransfer(in_.vpls, d.index, *tile_.bsdf[receivers_[r]], t))
          light += d.weight * mean(t.transfer * in_.vpls.intensity[d.index]);
      }
      order.emplace_back(light, d);
    }
    std::ranges::stable_sort(order, std::greater{}, [](const auto& o) { return o.first; });
    std::vector<VplDraw> sorted;
    for (const auto& [light, draw] : order) sorted.push_back(draw);
    return sorted;
  }

  // Lights the receivers by one VPL. Rounds of ever more sampled entries end when as many of the
  // known columns as these can judge agree with them.
  void addColumn(const VplDraw& draw, Rng rng) {
    beginColumn(draw);
    if (rows_.empty()) return;
    const auto all = rows_.size();
    auto wanted =
        std::max(kMinEntries, static_cast<size_t>(std::ceil(share_ * static_cast<double>(all))));
    for (; 2 * wanted <= all; wanted *= 2) {
      sampleUpTo(wanted, draw, rng);
      const std::span sampled = std::span(rows_).first(wanted);
      const auto fitted = basis_.fit(sampled, visible_, std::min(basis_.size(), wanted / 2));
      if (!agrees(fitted)) continue;
      for (size_t k = 0; k < all; ++k)
        addEntry(rows_[k], draw, k < wanted ? visible_[k] : basis_.at(rows_[k], fitted));
      for (size_t k = wanted; k < all; ++k) ++out_[receivers_[rows_[k]]].counts[0];
      return;
    }
    sampleUpTo(all, draw, rng);
    basis_.add(rows_, visible_);
    for (size_t k = 0; k < all; ++k) addEntry(rows_[k], draw, visible_[k]);
    for (const uint32_t i : receivers_) ++out_[i].counts[1];
  }

 private:
  // Finds the rows that the VPL may light.
  void beginColumn(const VplDraw& draw) {
    rows_.clear();
    visible_.clear();
    for (uint32_t r = 0; r < receivers_.size(); ++r) {
      Gathered& out = out_[receivers_[r]];
      ++out.cut;
      if (!unoccludedTransfer(in_.vpls, draw.index, *tile_.bsdf[receivers_[r]], transfer_[r]))
        continue;
      out.sampledPairs += transfer_[r].sampled;
      rows_.push_back(r);
    }
  }
  // Samples further entries, in random rows, which it moves to the front.
  void sampleUpTo(size_t count, const VplDraw& draw, Rng& rng) {
    while (visible_.size() < count) {
      const size_t k = visible_.size(), left = rows_.size() - k;
      const auto pick = static_cast<size_t>(double{rng.next()} * static_cast<double>(left));
      std::swap(rows_[k], rows_[k + pick]);
      ++out_[receivers_[rows_[k]]].shadowRays;
      const bool hidden = in_.accel.occluded(from_[rows_[k]], in_.vpls.position[draw.index]);
      visible_.push_back(hidden ? 0.0 : 1.0);
    }
  }
  // Whether the fit is that of the sampled entries.
  bool agrees(std::span<const double> fitted) const {
    for (size_t k = 0; k < visible_.size(); ++k)
      if (std::abs(basis_.at(rows_[k], fitted) - visible_[k]) > kTolerance) return false;
    return true;
  }
  void addEntry(uint32_t row, const VplDraw& draw, double visibility) {
    const float weight = draw.weight * static_cast<float>(std::clamp(visibility, 0.0, 1.0));
    const uint32_t i = receivers_[row];
    addTransfer(in_.vpls, draw.index, transfer_[row], weight, tile_.groupsOf(i), out_[i]);
  }

  const GatherInputs& in_;
  const TileReceivers& tile_;
  std::vector<uint32_t> receivers_;  // in the tile, of each row
  double share_;
  std::span<Gathered> out_;
  ColumnBasis basis_;
  std::vector<Vec3> from_;
  // The column at hand: its transfer by row, the rows that it may light, and the visibility of the
  // first of these, which are sampled.
  std::vector<VplTransfer> transfer_;
  std::vector<uint32_t> rows_;
  std::vector<double> visible_;
};

Gather make(const GatherInputs& in, const Values& options) {
  const auto plan = std::make_shared<const SlicePlan>(makeSlicePlan(in, options));
  return {.tile =
              [in, plan, share = options[kShareOption]](const TileReceivers& tile,
                                                        std::span<Gathered> out) {
                std::ranges::fill(out, Gathered{});
                if (plan->draws.empty()) return;
                std::map<size_t, std::vector<uint32_t>> slices;
                for (uint32_t i = 0; i < out.size(); ++i)
                  if (tile.bsdf[i]) slices[plan->sliceOf(tile.bsdf[i]->point())].push_back(i);
                for (auto& [slice, receivers] : slices) {
                  SliceMatrix matrix(in, tile, std::move(receivers), share, out);
                  const auto draws =
                      matrix.byBrightness(plan->draws[slice].of(tile, tile.firstSample));
                  const uint64_t key = random64(tile.key, slice, 0);
                  for (size_t k = 0; k < draws.size(); ++k) matrix.addColumn(draws[k], Rng(key, k));
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
