// The many-light matrix of one slice within a tile: a row for each receiver, a column for each VPL.
// Its transfer is known, its visibility is what shadow rays tell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "tools/render/gather/matrix_columns.h"

namespace bnvpl::methods::gather::matrix_completion {

enum class Visibility : int8_t { Hidden = -1, Unknown = 0, Visible = 1 };

// A column in the rows that its VPL may light. The first sampled() of these have a shadow ray.
struct Column {
  VplDraw draw;
  std::vector<uint32_t> rows;
  std::vector<VplTransfer> transfer;   // that of these rows, without visibility
  std::vector<double> visible;         // 0 or 1, for the sampled rows
  std::vector<Visibility> visibility;  // by row of the matrix

  size_t sampled() const { return visible.size(); }
};

// Borrows all but the receivers. Results go to `out`, one for each receiver of the tile.
class SliceMatrix {
 public:
  SliceMatrix(const GatherInputs& in, const TileReceivers& tile, std::vector<uint32_t> receivers,
              std::span<Gathered> out);

  size_t rows() const { return receivers_.size(); }
  const SurfacePoint& point(uint32_t row) const { return tile_.bsdf[receivers_[row]]->point(); }
  Vec3 vplPosition(const Column& column) const { return in_.vpls.position[column.draw.index]; }
  // The draws by falling light at a few of the receivers, without visibility.
  std::vector<VplDraw> byBrightness(std::span<const VplDraw> draws) const;

  // The column of a VPL. Counts it as evaluated at each receiver.
  Column column(const VplDraw& draw);
  // Moves `count` random rows behind the sampled ones. Returns them; they are fewer at the end.
  static std::span<const uint32_t> choose(Column& column, size_t count, Rng& rng);
  // Casts the shadow rays of the next `count` rows.
  void sample(Column& column, size_t count);
  // Light of entry k without visibility, mean of the channels, times the draw's weight.
  float light(const Column& column, size_t k) const;

  // Adds the light of entry k, with a visibility that is clamped to 0..1, to its receiver.
  void add(const Column& column, size_t k, double visibility);
  // Adds the sampled entries; then the others with visibility(k), counted as completed.
  template <typename Fn>
  void addAll(const Column& column, const Fn& visibility) {
    for (size_t k = 0; k < column.rows.size(); ++k) {
      const bool known = k < column.sampled();
      add(column, k, known ? column.visible[k] : visibility(k));
      if (!known) ++out_[receivers_[column.rows[k]]].counts[0];
    }
  }
  // Counts a column that every receiver traces.
  void countFull() {
    for (const uint32_t i : receivers_) ++out_[i].counts[1];
  }

 private:
  const GatherInputs& in_;
  const TileReceivers& tile_;
  std::vector<uint32_t> receivers_;  // in the tile, of each row
  std::span<Gathered> out_;
  std::vector<Vec3> from_;  // origins of shadow rays
};

// Entries of a column of `rows` that are sampled first.
size_t firstEntries(double share, size_t rows);

// Gather the light of these draws. Columns come in their order; random numbers are of `key`.
using Complete = void (*)(SliceMatrix&, std::span<const VplDraw> draws, double share, uint64_t key);
// Adaptive column sampling (Huo et al. 2016).
void completeFromColumns(SliceMatrix&, std::span<const VplDraw>, double share, uint64_t key);
// Prediction and matrix separation (Huo et al. 2015).
void completeBySeparation(SliceMatrix&, std::span<const VplDraw>, double share, uint64_t key);

}  // namespace bnvpl::methods::gather::matrix_completion
