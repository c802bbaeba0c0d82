// The pixel filter of a film: its kind and size. tools/render/pixel_filter.h samples it.
#pragma once

#include <array>
#include <cstddef>

namespace bnvpl {

enum class FilterKind { Box, Gaussian, BlackmanHarris, Mitchell };
inline constexpr std::array kFilterNames{"box", "gaussian", "blackman-harris", "mitchell"};
// Limits of a filter's radius, which is half its width, in pixels.
inline constexpr double kMinFilterRadius = 0.25, kMaxFilterRadius = 8.0;

constexpr const char* nameOf(FilterKind kind) { return kFilterNames[static_cast<size_t>(kind)]; }
constexpr float usualRadius(FilterKind kind) {
  constexpr std::array kRadii{0.5f, 1.5f, 1.5f, 2.0f};
  return kRadii[static_cast<size_t>(kind)];
}

struct FilterSpec {
  FilterKind kind = FilterKind::Box;
  float radius = usualRadius(FilterKind::Box);
  bool operator==(const FilterSpec&) const = default;
};

}  // namespace bnvpl
