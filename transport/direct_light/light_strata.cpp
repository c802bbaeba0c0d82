#include "transport/direct_light/light_strata.h"

#include <cmath>

#include "core/cdf.h"
#include "spatial/morton_order.h"

namespace bnvpl {

namespace {

constexpr double kMin = 0.1;  // min probability of a stratum, relative to a uniform share

}  // namespace

LightStrata::LightStrata(const LightSet& lights, size_t maxStrata) : cells_(lights.size()) {
  for (uint32_t i = 0; i < lights.size(); ++i) {
    cells_[i].share = lights.pickProbability(i);
    if (cells_[i].share > 0.0f) order_.push_back(i);
  }
  if (2 * order_.size() <= maxStrata) {
    divideLights(lights, maxStrata);
  } else {
    groupLights(lights, maxStrata);
  }
}

// Each light has a stratum; divisible lights get the remaining ones in proportion to power.
void LightStrata::divideLights(const LightSet& lights, size_t maxStrata) {
  std::vector<LightSet::Extent> extents;
  double divisible = 0.0;
  for (const uint32_t i : order_) {
    extents.push_back(lights.extent(i));
    if (extents.back().divisible) divisible += double{cells_[i].share};
  }
  const auto left = static_cast<double>(maxStrata - order_.size());
  const std::vector<uint32_t> own = order_;
  order_.clear();
  for (size_t k = 0; k < own.size(); ++k) {
    const double more = extents[k].divisible ? left * double{cells_[own[k]].share} / divisible : 0;
    add(own[k], extents[k], 1 + static_cast<size_t>(more));
  }
}

// Divides a light into `parts` strata: a column for each of many facets; else as many columns as
// rows, or twice as many for lights at infinity.
void LightStrata::add(uint32_t light, const LightSet::Extent& extent, size_t parts) {
  Cells& c = cells_[light];
  const double aspect = extent.local ? 1.0 : 2.0;
  const auto square = static_cast<size_t>(std::sqrt(aspect * static_cast<double>(parts)));
  c.columns =
      static_cast<uint32_t>(std::clamp<size_t>(extent.facets, std::max<size_t>(1, square), parts));
  c.rows = static_cast<uint32_t>(parts / c.columns);
  c.first = static_cast<uint32_t>(strata_.size());
  const auto at = static_cast<uint32_t>(order_.size());
  order_.push_back(light);
  cdf_.push_back(1.0f);
  const uint32_t count = c.columns * c.rows;
  for (uint32_t cell = 0; cell < count; ++cell)
    strata_.push_back({at, at + 1, cell, c.share / static_cast<float>(count)});
}

// Groups neighbours along a Morton curve until they have an equal part of the power. Lights at
// infinity have a stratum each.
void LightStrata::groupLights(const LightSet& lights, size_t maxStrata) {
  std::vector<uint32_t> local, own = order_;
  std::vector<Vec3> centres;
  order_.clear();
  for (const uint32_t i : own) {
    const LightSet::Extent extent = lights.extent(i);
    if (extent.local) {
      local.push_back(i);
      centres.push_back(extent.centre);
    } else {
      add(i, {}, 1);
    }
  }
  double total = 0.0;
  for (const uint32_t i : local) total += double{cells_[i].share};
  const double part =
      total / static_cast<double>(maxStrata - std::min(maxStrata - 1, order_.size()));
  std::vector<double> weights;
  double sum = 0.0;
  for (const uint32_t k : mortonOrder(centres)) {
    const uint32_t light = local[k];
    order_.push_back(light);
    weights.push_back(double{cells_[light].share});
    cells_[light].first = static_cast<uint32_t>(strata_.size());
    sum += weights.back();
    if (sum < part && order_.size() < own.size()) continue;
    const auto end = static_cast<uint32_t>(order_.size());
    strata_.push_back(
        {end - static_cast<uint32_t>(weights.size()), end, 0, static_cast<float>(sum)});
    const std::vector<float> cdf = makeCdf<float>(weights);
    cdf_.insert(cdf_.end(), cdf.begin(), cdf.end());
    weights.clear();
    sum = 0.0;
  }
}

LightPoint LightStrata::samplePoint(size_t stratum, Point2 at) const {
  const Stratum& s = strata_[stratum];
  if (s.end - s.begin > 1) {
    const size_t i = sampleCdf(std::span(cdf_).subspan(s.begin, s.end - s.begin), at.x);
    return {order_[s.begin + i], at};
  }
  const uint32_t light = order_[s.begin];
  const Cells& c = cells_[light];
  const auto within = [](uint32_t cell, float part, uint32_t count) {
    return std::min((static_cast<float>(cell) + part) / static_cast<float>(count), 0x1.fffffep-1f);
  };
  return {light,
          {within(s.cell % c.columns, at.x, c.columns), within(s.cell / c.columns, at.y, c.rows)}};
}

uint32_t LightStrata::stratumOf(const LightPoint& place) const {
  const Cells& c = cells_[place.light];
  if (c.first == kNone) return kNone;
  const auto cellOf = [](float x, uint32_t count) {
    return std::min(count - 1,
                    static_cast<uint32_t>(std::max(0.0f, x) * static_cast<float>(count)));
  };
  return c.first + cellOf(place.at.y, c.rows) * c.columns + cellOf(place.at.x, c.columns);
}

float StrataDistribution::probability(uint32_t stratum) const {
  const auto it = std::lower_bound(strata.begin(), strata.end(), stratum);
  return it != strata.end() && *it == stratum
             ? cdfProbability(cdf, static_cast<size_t>(it - strata.begin()))
             : 0.0f;
}

StrataValues distributionOf(std::span<const float> values) {
  double total = 0.0, kept = 0.0, running = 0.0;
  for (const float v : values) total += double{v};
  const double least = total * kMin / static_cast<double>(values.size());
  for (const float v : values) kept += double{v} > least ? double{v} : 0.0;
  StrataValues out;
  for (uint32_t s = 0; s < values.size(); ++s) {
    if (!(double{values[s]} > least)) continue;
    running += double{values[s]};
    out.strata.push_back(s);
    out.values.push_back(static_cast<float>(running / kept));
  }
  if (!out.values.empty()) out.values.back() = 1.0f;
  return out;
}

StrataValues meanOf(std::span<const StrataValues> distributions, size_t strata) {
  std::vector<float> sum(strata);
  for (const StrataValues& d : distributions)
    for (size_t k = 0; k < d.strata.size(); ++k)
      sum[d.strata[k]] += cdfProbability<float>(d.values, k);
  return distributionOf(sum);
}

uint32_t LearnedStrata::pick(float& u) const {
  const auto below = [](float x) { return std::min(x, 0x1.fffffep-1f); };
  const float first = hereShare(), second = everywhereShare();
  if (u < first) {
    u = below(u / first);
    return here.strata[sampleCdf(here.cdf, u)];
  }
  if (u < first + second) {
    u = below((u - first) / second);
    return everywhere.strata[sampleCdf(everywhere.cdf, u)];
  }
  // Rounding may make the difference negative.
  const float rest = std::max(0.0f, u - first - second);
  const float x = rest / (1.0f - first - second) * static_cast<float>(all->size());
  const auto i = std::min(static_cast<uint32_t>(all->size() - 1), static_cast<uint32_t>(x));
  u = below(x - static_cast<float>(i));
  return i;
}

float LearnedStrata::probability(uint32_t stratum) const {
  const float first = hereShare(), second = everywhereShare();
  float sum = (1.0f - first - second) / static_cast<float>(all->size());
  if (first > 0.0f) sum += first * here.probability(stratum);
  if (second > 0.0f) sum += second * everywhere.probability(stratum);
  return sum;
}

float LearnedStrata::density(const LightPoint& place) const {
  const uint32_t stratum = all->stratumOf(place);
  return stratum == kNone ? 0.0f : density(stratum, place.light);
}

}  // namespace bnvpl
