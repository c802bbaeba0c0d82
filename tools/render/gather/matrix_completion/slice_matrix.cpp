#include "tools/render/gather/matrix_completion/slice_matrix.h"

#include <algorithm>
#include <cmath>

#include "tools/render/gather/single_vpl.h"

namespace bnvpl::methods::gather::matrix_completion {

SliceMatrix::SliceMatrix(const GatherInputs& in, const TileReceivers& tile,
                         std::vector<uint32_t> receivers, std::span<Gathered> out)
    : in_(in), tile_(tile), receivers_(std::move(receivers)), out_(out) {
  for (uint32_t r = 0; r < rows(); ++r)
    from_.push_back(in_.accel.offsetOrigin(point(r).position, point(r).ng));
}

std::vector<VplDraw> SliceMatrix::byBrightness(std::span<const VplDraw> draws) const {
  constexpr size_t kReceivers = 8;
  const size_t step = std::max<size_t>(1, rows() / kReceivers);
  std::vector<std::pair<float, VplDraw>> order;
  for (const VplDraw& d : draws) {
    float light = 0.0f;
    VplTransfer t;
    for (size_t r = 0; r < rows(); r += step) {
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

Column SliceMatrix::column(const VplDraw& draw) {
  Column column;
  column.draw = draw;
  column.visibility.assign(rows(), Visibility::Unknown);
  for (uint32_t r = 0; r < rows(); ++r) {
    Gathered& out = out_[receivers_[r]];
    ++out.cut;
    VplTransfer t;
    if (!unoccludedTransfer(in_.vpls, draw.index, *tile_.bsdf[receivers_[r]], t)) continue;
    out.sampledPairs += t.sampled;
    column.rows.push_back(r);
    column.transfer.push_back(t);
  }
  return column;
}

std::span<const uint32_t> SliceMatrix::choose(Column& column, size_t count, Rng& rng) {
  const size_t first = column.sampled(), all = column.rows.size();
  count = std::min(count, all - first);
  for (size_t k = first; k < first + count; ++k) {
    const auto pick = k + static_cast<size_t>(double{rng.next()} * static_cast<double>(all - k));
    std::swap(column.rows[k], column.rows[pick]);
    std::swap(column.transfer[k], column.transfer[pick]);
  }
  return std::span(column.rows).subspan(first, count);
}

void SliceMatrix::sample(Column& column, size_t count) {
  for (; count > 0; --count) {
    const uint32_t row = column.rows[column.sampled()];
    ++out_[receivers_[row]].shadowRays;
    const bool hidden = in_.accel.occluded(from_[row], vplPosition(column));
    column.visible.push_back(hidden ? 0.0 : 1.0);
    column.visibility[row] = hidden ? Visibility::Hidden : Visibility::Visible;
  }
}

float SliceMatrix::light(const Column& column, size_t k) const {
  return column.draw.weight *
         mean(column.transfer[k].transfer * in_.vpls.intensity[column.draw.index]);
}

void SliceMatrix::add(const Column& column, size_t k, double visibility) {
  const float weight = column.draw.weight * static_cast<float>(std::clamp(visibility, 0.0, 1.0));
  const uint32_t i = receivers_[column.rows[k]];
  addTransfer(in_.vpls, column.draw.index, column.transfer[k], weight, tile_.groupsOf(i), out_[i]);
}

size_t firstEntries(double share, size_t rows) {
  constexpr size_t kMinEntries = 16;
  return std::max(kMinEntries, static_cast<size_t>(std::ceil(share * static_cast<double>(rows))));
}

}  // namespace bnvpl::methods::gather::matrix_completion
