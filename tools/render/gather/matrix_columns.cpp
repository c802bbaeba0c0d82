#include "tools/render/gather/matrix_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/cdf.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "tools/render/gather/single_vpl.h"

namespace bnvpl {

namespace {

double lengthOf(std::span<const float> column) {
  double squares = 0.0;
  for (const float v : column) squares += double{v} * double{v};
  return std::sqrt(squares);
}

}  // namespace

void Columns::measure() {
  parallelFor(size(), 256, [&](size_t i) { norms_[i] = lengthOf((*this)[i]); });
}

Columns Columns::inRows(std::span<const size_t> rows) const {
  Columns out(size(), rows.size());
  for (size_t i = 0; i < size(); ++i) {
    const float* from = values_.data() + i * entries_;
    float* to = out.values_.data() + i * out.entries_;
    for (const size_t row : rows) to = std::copy_n(from + 3 * row, 3, to);
  }
  out.measure();
  return out;
}

Columns columnsAt(const GatherInputs& in, std::span<const SurfacePoint> receivers,
                  std::string_view phase, std::string_view count) {
  requireMemory(double{sizeof(Vec3)} * double(in.vpls.size()) * double(receivers.size()),
                "the matrix of " + std::to_string(receivers.size()) + " rows and " +
                    std::to_string(in.vpls.size()) + " lights of VPLs",
                "lower --" + std::string(count) + ", or keep fewer VPLs with vpl-eliminate -n");
  Columns columns(in.vpls.size(), receivers.size());
  const auto running = in.progress.beginPhase(phase, receivers.size());
  parallelFor(receivers.size(), 1, [&](size_t row) {
    const Bsdf bsdf(in.accel.scene(), receivers[row]);
    const ShadowTest test(in.accel, in.vpls, bsdf);
    for (size_t i = 0; i < columns.size(); ++i) columns.set(i, row, test.of(i).radiance);
    if (in.progress) in.progress(1);
  });
  columns.measure();
  return columns;
}

void Bundle::add(const Columns& columns, size_t i, double weight) {
  const std::span<const float> column = columns[i];
  sum_.resize(column.size());
  for (size_t k = 0; k < column.size(); ++k) sum_[k] += weight * double{column[k]};
  norms_ += weight * columns.norm(i);
}

double Bundle::cost() const {
  double squares = 0.0;
  for (const double v : sum_) squares += v * v;
  return std::max(0.0, norms_ * norms_ - squares);
}

double Bundle::apart(const Columns& columns, size_t i) const {
  const std::span<const float> column = columns[i];
  std::array<double, 8> parts{};  // sums that the compiler can vectorise
  size_t k = 0;
  for (; k + parts.size() <= column.size(); k += parts.size())
    for (size_t j = 0; j < parts.size(); ++j) parts[j] += sum_[k + j] * double{column[k + j]};
  double product = std::accumulate(parts.begin(), parts.end(), 0.0);
  for (; k < column.size(); ++k) product += sum_[k] * double{column[k]};
  return std::max(0.0, norms_ * columns.norm(i) - product);
}

Bundle bundleOf(std::span<const uint32_t> cluster, const Columns& columns) {
  Bundle bundle;
  for (const uint32_t i : cluster) bundle.add(columns, i);
  return bundle;
}

namespace {

std::vector<double> cdfOf(std::span<const uint32_t> cluster, std::span<const double> shares) {
  std::vector<double> own;
  own.reserve(cluster.size());
  for (const uint32_t i : cluster) own.push_back(shares[i]);
  return makeCdf<double>(own);
}

VplDraw drawByCdf(std::span<const uint32_t> cluster, std::span<const double> cdf, Rng& rng) {
  float u = rng.next();
  const size_t k = sampleCdf<double>(cdf, u);
  return {cluster[k], static_cast<float>(1.0 / cdfProbability<double>(cdf, k))};
}

}  // namespace

VplDraw drawFrom(std::span<const uint32_t> cluster, std::span<const double> shares, Rng& rng) {
  return drawByCdf(cluster, cdfOf(cluster, shares), rng);
}

void ClusterDraws::add(std::span<const uint32_t> cluster, std::span<const double> shares,
                       Rng& rng) {
  const std::vector<double> cdf = cdfOf(cluster, shares);
  for (auto& draws : draws_) draws.push_back(drawByCdf(cluster, cdf, rng));
}

Gathered ClusterDraws::gather(const GatherInputs& in, const TileReceivers& tile, size_t i) const {
  Gathered out;
  const std::span<const VplDraw> draws = of(tile, tile.sampleIndex(i));
  const ShadowTest test(in.accel, in.vpls, *tile.bsdf[i], tile.groupsOf(i));
  for (const VplDraw& d : draws) test.add(d.index, d.weight, out);
  out.cut = static_cast<uint32_t>(draws.size());
  return out;
}

std::vector<Cluster> clustersBySampling(const Cluster& vpls, const Columns& columns, size_t count,
                                        Rng& rng) {
  const Bundle all = bundleOf(vpls, columns);
  std::vector<double> alpha(columns.size());
  for (const uint32_t i : vpls) alpha[i] = all.apart(columns, i);
  std::map<uint32_t, Bundle> centres;
  for (size_t k = 0; k < count; ++k) {
    const VplDraw centre = drawFrom(vpls, alpha, rng);
    centres[centre.index].add(columns, centre.index, double{centre.weight});
  }
  std::vector<uint32_t> nearest(columns.size());
  parallelFor(vpls.size(), 64, [&](size_t k) {
    double least = INFINITY;
    for (const auto& [centre, bundle] : centres) {
      const double apart = bundle.apart(columns, vpls[k]);
      if (apart < least) least = apart, nearest[vpls[k]] = centre;
    }
  });
  std::map<uint32_t, Cluster> clusters;
  for (const uint32_t i : vpls) clusters[nearest[i]].push_back(i);
  std::vector<Cluster> out;
  for (auto& [centre, cluster] : clusters) out.push_back(std::move(cluster));
  return out;
}

std::vector<Cluster> clustersOfSeenAndUnseen(const Columns& columns, size_t count, Rng& rng) {
  Cluster seen, unseen;
  for (uint32_t i = 0; i < columns.size(); ++i)
    (columns.norm(i) > 0.0 ? seen : unseen).push_back(i);
  std::vector<Cluster> clusters;
  if (!seen.empty()) clusters = clustersBySampling(seen, columns, count, rng);
  if (!unseen.empty()) clusters.push_back(std::move(unseen));
  return clusters;
}

std::vector<double> sharesOf(const VplLights& vpls, const Columns& columns) {
  constexpr double kFluxShare = 0.2;
  std::vector<double> shares(columns.size());
  double norms = 0.0, flux = 0.0;
  for (size_t i = 0; i < shares.size(); ++i)
    norms += columns.norm(i), flux += double{mean(vpls.intensity[i])};
  for (size_t i = 0; i < shares.size(); ++i) {
    shares[i] = kFluxShare * double{mean(vpls.intensity[i])} / flux;
    if (norms > 0.0) shares[i] += (1.0 - kFluxShare) * columns.norm(i) / norms;
  }
  return shares;
}

}  // namespace bnvpl
