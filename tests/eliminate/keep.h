// Runs the elimination stage on a cloud of points.
#pragma once

#include <numeric>
#include <string>

#include "tests/eliminate/clouds.h"
#include "tools/eliminate/eliminate.h"

namespace bnvpl {

struct KeptRows {
  std::vector<uint32_t> rows;  // ascending
  std::vector<float> radius;   // radius of each row
  double rMax = 0.0, area = 0.0;
};

inline VplTable tableOf(const Cloud& cloud) {
  VplTable table;
  table.position = cloud.position;
  table.normal = cloud.normal;
  table.albedo.resize(cloud.size());
  table.id.resize(cloud.size());
  std::iota(table.id.begin(), table.id.end(), 0u);
  return table;
}

inline KeptRows keepRowsOf(const Cloud& cloud, const Given& options) {
  const VplTable kept = eliminate(tableOf(cloud), resolve(eliminateSpec(), options));
  return {kept.id, kept.radius, kept.rMax, kept.areaEstimate};
}

inline const char* const kDensities[] = {"uniform", "local"};

// Options that keep `count` candidates.
inline Given keep(uint64_t count, const std::string& density = "uniform") {
  return {{"count", std::to_string(count)}, {"density", density}};
}
// `options` followed by `more`; a later option overrides an earlier one of the same name.
inline Given with(Given options, const Given& more) {
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

}  // namespace bnvpl
