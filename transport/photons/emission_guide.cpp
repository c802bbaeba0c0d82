#include "transport/photons/emission_guide.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace bnvpl {

namespace {

// A cell with fewer useful pilot photons is not split.
constexpr size_t kMinToSplit = 8;
// Each half of a cell gets so many of the cell's useful photons besides its own, as a half without
// any is not empty for certain.
constexpr double kPrior = 0.1;
// Share of the photons that are emitted by power. It bounds the weight of a photon that starts
// where the pilot found nothing.
constexpr double kDefensive = 0.2;
// A guide must promise a second moment below this one relative to emission by power. The promise is
// optimistic, as it is made by the photons from which the cells were learned.
constexpr double kWorthwhile = 0.6;
constexpr unsigned kRounds = 8;
// With fewer useful photons, proxies guide the next round.
constexpr size_t kFew = 128;
// If so many useful photons do not make a guide, further rounds will not.
constexpr size_t kEnough = 4096;
constexpr float kMinCellSide = 0x1p-16f;  // smallest side of a cell

}  // namespace

// Splits cells at the middle of the side that lets sum(sqrt(m2 measure)) fall most: the square of
// this sum is the second moment under the best density.
class EmissionGuide::Builder {
 public:
  Builder(EmissionGuide& guide, double traced) : guide_(guide), traced_(traced) {}

  // Adds the tree of a light, whose useful photons are given in any order.
  void add(uint32_t light, std::span<PilotPhoton> photons) {
    photons_ = photons;
    double sum = 0.0;
    for (const PilotPhoton& p : photons) sum += p.squares;
    Cell all{light, {}, {1.0f, 1.0f, 1.0f, 1.0f}, 0.0f};
    guide_.root_.push_back(static_cast<uint32_t>(guide_.nodes_.size()));
    guide_.nodes_.emplace_back();
    measure_ = double{guide_.lights_->pickProbability(light)};
    split(guide_.root_.back(), all, 0, photons.size(), sum / traced_);
  }
  // Second moment of a cell, and its measure P(l) du.
  std::vector<double> moments, measures;

 private:
  static double volume(const Cell& c) {
    return double{c.size[0]} * double{c.size[1]} * double{c.size[2]} * double{c.size[3]};
  }
  double sumOf(size_t begin, size_t end) const {
    double sum = 0.0;
    for (size_t k = begin; k < end; ++k) sum += photons_[k].squares;
    return sum / traced_;
  }

  void split(uint32_t node, const Cell& cell, size_t begin, size_t end, double m2) {
    const unsigned dimension = end - begin < kMinToSplit ? 4 : sideToSplit(cell, begin, end);
    if (dimension == 4) {
      guide_.nodes_[node] = {4, 0.0f, static_cast<uint32_t>(guide_.cells_.size())};
      guide_.cells_.push_back(cell);
      moments.push_back(m2);
      measures.push_back(measure_ * volume(cell));
      return;
    }
    Cell low = cell, high = cell;
    low.size[dimension] = high.size[dimension] = 0.5f * cell.size[dimension];
    const float middle = cell.lower[dimension] + low.size[dimension];
    high.lower[dimension] = middle;
    const auto half = std::stable_partition(
        photons_.begin() + std::ptrdiff_t(begin), photons_.begin() + std::ptrdiff_t(end),
        [&](const PilotPhoton& p) { return p.emission.at[dimension] < middle; });
    const auto between = static_cast<size_t>(half - photons_.begin());
    const auto child = static_cast<uint32_t>(guide_.nodes_.size());
    guide_.nodes_[node] = {static_cast<uint8_t>(dimension), middle, child};
    guide_.nodes_.resize(child + 2);
    const double lowSum = sumOf(begin, between), highSum = sumOf(between, end);
    const auto count = static_cast<double>(end - begin);
    const double own = lowSum + highSum, prior = kPrior / (count + 2.0 * kPrior);
    const double scale = own > 0.0 ? (1.0 - 2.0 * prior) * m2 / own : 0.0;
    split(child, low, begin, between, scale * lowSum + prior * m2);
    split(child + 1, high, between, end, scale * highSum + prior * m2);
  }

  unsigned sideToSplit(const Cell& cell, size_t begin, size_t end) const {
    unsigned best = 4;
    double least = INFINITY;
    for (const unsigned d : guide_.lights_->primaryDimensions(cell.light)) {
      if (!(cell.size[d] > kMinCellSide)) continue;
      const float middle = cell.lower[d] + 0.5f * cell.size[d];
      double low = 0.0, high = 0.0;
      for (size_t k = begin; k < end; ++k)
        (photons_[k].emission.at[d] < middle ? low : high) += photons_[k].squares;
      const double cost = std::sqrt(low) + std::sqrt(high);
      if (cost < least) least = cost, best = d;
    }
    return best;
  }

  EmissionGuide& guide_;
  double traced_, measure_ = 0.0;
  std::span<PilotPhoton> photons_;
};

EmissionGuide::EmissionGuide(const LightSet& lights, std::span<const PilotPhoton> useful,
                             double traced)
    : lights_(&lights) {
  if (useful.size() < kMinToSplit) return;
  std::vector<PilotPhoton> photons(useful.begin(), useful.end());
  std::ranges::stable_sort(photons, {}, [](const PilotPhoton& p) { return p.emission.light; });
  Builder builder(*this, traced);
  size_t begin = 0;
  for (uint32_t light = 0; light < lights.size(); ++light) {
    size_t end = begin;
    while (end < photons.size() && photons[end].emission.light == light) ++end;
    builder.add(light, std::span(photons).subspan(begin, end - begin));
    begin = end;
  }
  double whole = 0.0, byPower = 0.0, guided = 0.0;
  for (size_t k = 0; k < cells_.size(); ++k) {
    whole += std::sqrt(builder.moments[k] * builder.measures[k]);
    byPower += builder.moments[k];
  }
  if (!(whole > 0.0)) {
    cells_.clear();
    return;
  }
  double sum = 0.0;
  for (size_t k = 0; k < cells_.size(); ++k) {
    const double measure = builder.measures[k];
    const double share =
        (1.0 - kDefensive) * std::sqrt(builder.moments[k] * measure) / whole + kDefensive * measure;
    cells_[k].density = measure > 0.0 ? static_cast<float>(share / measure) : 0.0f;
    if (share > 0.0) guided += builder.moments[k] * measure / share;
    sum += share;
    cdf_.push_back(sum);
  }
  for (double& c : cdf_) c /= sum;
  cdf_.back() = 1.0;
  if (!(guided / byPower < kWorthwhile)) cdf_.clear();
}

EmissionSample EmissionGuide::draw(double choice, Rng& rng, float& density) const {
  EmissionSample e;
  if (!guides()) {
    density = 1.0f;
    float probability = 0.0f;
    e.light = static_cast<uint32_t>(
        lights_->pick(std::min(static_cast<float>(choice), 0x1.fffffep-1f), probability));
    e.at = lights_->primarySample(e.light, rng);
    return e;
  }
  const auto chosen = std::upper_bound(cdf_.begin(), cdf_.end() - 1, choice) - cdf_.begin();
  const Cell& cell = cells_[static_cast<size_t>(chosen)];
  e.light = cell.light;
  density = cell.density;
  for (size_t d = 0; d < e.at.size(); ++d)
    // Rounding must not lead into the next cell, whose density is another.
    e.at[d] = std::min(cell.lower[d] + rng.next() * cell.size[d],
                       std::nextafter(cell.lower[d] + cell.size[d], 0.0f));
  return e;
}

float EmissionGuide::density(const EmissionSample& e) const {
  if (!guides()) return 1.0f;
  const Node* node = &nodes_[root_[e.light]];
  while (node->dimension < 4)
    node = &nodes_[node->child + (e.at[node->dimension] < node->middle ? 0 : 1)];
  return cells_[node->child].density;
}

namespace {

using PilotPhotons = std::vector<EmissionGuide::PilotPhoton>;

// Useful photons by target and by proxy. `squares` is f^2 by power here.
struct Round {
  PilotPhotons targets, proxies;
};

Round traceRound(const LightSet& lights, const EmissionGuide& guide, uint64_t count, uint64_t key,
                 bool withProxy, const PilotEstimator& estimate, const ProgressFn& progress) {
  constexpr uint64_t kChunk = 1024;
  std::vector<Round> chunks((count + kChunk - 1) / kChunk);
  parallelFor(chunks.size(), 1, [&](size_t k) {
    Round& chunk = chunks[k];
    const uint64_t begin = k * kChunk, end = std::min(count, begin + kChunk);
    for (uint64_t i = begin; i < end; ++i) {
      Rng rng(key, i);
      const double choice = (double(i) + double{rng.next()}) / double(count);
      float density = 0.0f;
      const EmissionSample e = guide.draw(choice, rng, density);
      const PilotContribution c = estimate(e, lights.emit(e.light, e.at), rng, withProxy);
      const auto add = [&](PilotPhotons& to, double contribution) {
        const double f = contribution / double{lights.pickProbability(e.light)};
        if (std::isfinite(f) && f > 0.0) to.push_back({e, f * f});
      };
      add(chunk.targets, c.target);
      if (withProxy) add(chunk.proxies, c.proxy);
    }
    if (progress) progress(end - begin);
  });
  Round all;
  for (const Round& c : chunks) {
    all.targets.insert(all.targets.end(), c.targets.begin(), c.targets.end());
    all.proxies.insert(all.proxies.end(), c.proxies.begin(), c.proxies.end());
  }
  return all;
}

// The useful photons of all rounds so far, by target or by proxy.
class FoundPhotons {
 public:
  // Adds those of a round. `guides`: those of all rounds, this one included.
  void add(const PilotPhotons& round, std::span<const EmissionGuide> guides) {
    const size_t before = photons_.size();
    photons_.insert(photons_.end(), round.begin(), round.end());
    density_.resize(photons_.size());
    rounds_ = double(guides.size());
    parallelFor(photons_.size(), 1024, [&](size_t i) {
      for (const EmissionGuide& g : i < before ? guides.last(1) : guides)
        density_[i] += double{g.density(photons_[i].emission)};
    });
  }
  size_t size() const { return photons_.size(); }
  // The mean density with which the rounds drew a photon (balance heuristic).
  double density(size_t photon) const { return density_[photon] / rounds_; }
  EmissionGuide guide(const LightSet& lights, uint64_t traced) const {
    PilotPhotons photons = photons_;
    for (size_t i = 0; i < photons.size(); ++i) photons[i].squares /= density(i);
    return {lights, photons, double(traced)};
  }

 private:
  PilotPhotons photons_;
  std::vector<double> density_;  // sum over the rounds
  double rounds_ = 0.0;
};

}  // namespace

LearnedEmission learnEmission(const LightSet& lights, uint64_t photons, uint64_t key,
                              const PilotEstimator& estimate, const ProgressFn& progress) {
  std::vector<EmissionGuide> guides;
  FoundPhotons targets, proxies;
  LearnedEmission out{EmissionGuide(lights)};
  const uint64_t count = std::max<uint64_t>(1, photons / kRounds);
  const auto phase = progress.beginPhase("emission pilot, photons", count * kRounds);
  for (unsigned round = 0; round < kRounds; ++round) {
    guides.push_back(out.guide);
    const bool withProxy = targets.size() < kFew;
    const Round now =
        traceRound(lights, out.guide, count, key + round, withProxy, estimate, progress);
    out.useful.guided = double(now.targets.size()) / double(count);
    targets.add(now.targets, guides);
    proxies.add(now.proxies, guides);
    out.enough = targets.size() >= kFew;
    // Some estimates have no proxy; a few targets guide then.
    const bool byTargets = out.enough || proxies.size() == 0;
    out.guide = (byTargets ? targets : proxies).guide(lights, count * (round + 1));
    if (!out.guide.guides() && targets.size() >= kEnough) break;
  }
  if (!out.guide.guides()) out.useful.guided = 0.0;
  for (size_t i = 0; i < targets.size(); ++i)
    out.useful.byPower += 1.0 / (targets.density(i) * double(count * guides.size()));
  return out;
}

}  // namespace bnvpl
