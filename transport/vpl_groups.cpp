#include "transport/vpl_groups.h"

#include <algorithm>
#include <string_view>

namespace bnvpl {

namespace {

constexpr std::string_view kFlux = "groups.flux", kFirstBounce = "groups.first_bounce";

VplExtraColumn columnOf(std::string_view name, uint32_t groups, const std::vector<Vec3>& colours) {
  std::vector<float> values;
  values.reserve(3 * colours.size());
  for (const Vec3 v : colours) values.insert(values.end(), {v.x, v.y, v.z});
  return {std::string(name), "W", 3 * groups, std::move(values)};
}

bool read(const VplTable& table, std::string_view name, uint32_t groups, std::vector<Vec3>& out) {
  const auto column = std::ranges::find(table.extras, name, &VplExtraColumn::name);
  if (column == table.extras.end() || column->components != 3 * groups) return false;
  const auto* values = std::get_if<std::vector<float>>(&column->values);
  if (!values) return false;
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = {(*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2]};
  return true;
}

}  // namespace

void addRoundingToLargest(std::span<Vec3> groups, Vec3 total) {
  for (size_t c = 0; c < 3 && !groups.empty(); ++c) {
    double sum = 0.0;
    Vec3* largest = &groups[0];
    for (Vec3& g : groups) {
      sum += double{g[c]};
      if (g[c] > (*largest)[c]) largest = &g;
    }
    (*largest)[c] =
        std::max(0.0f, static_cast<float>(double{(*largest)[c]} + double{total[c]} - sum));
  }
}

void addVplGroups(const VplGroups& groups, VplTable& table) {
  std::erase_if(table.extras,
                [](const VplExtraColumn& c) { return c.name == kFlux || c.name == kFirstBounce; });
  table.extras.push_back(columnOf(kFlux, groups.groups, groups.flux));
  table.extras.push_back(columnOf(kFirstBounce, groups.groups, groups.firstBounceFlux));
}

VplGroups vplGroupsOf(const VplTable& table, uint32_t groups) {
  VplGroups out(table.size(), groups);
  const bool has = read(table, kFlux, groups, out.flux) &&
                   read(table, kFirstBounce, groups, out.firstBounceFlux);
  return has ? out : VplGroups{};
}

}  // namespace bnvpl
