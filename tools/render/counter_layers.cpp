#include "tools/render/counter_layers.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "core/errors.h"
#include "tools/render/integrator/integrator_method.h"
#include "tools/render/integrator/vpl_kind.h"

namespace bnvpl {

namespace {

// The counter of VPLs that are not seen from their centre.
constexpr std::array kSphereCounters{
    Counter{"sampledpairs", "sampled pairs",
            "VPLs whose light is a mean over directions of their sphere, without a closed form"}};

std::span<const Counter> lightCounters(VplKind kind) {
  return isFromCentre(kind) ? std::span<const Counter>() : kSphereCounters;
}

// Calls fn(counter, "--gather NAME", "gather") for the counters of all methods and kinds of light.
template <typename Fn>
void forEachCounter(const Fn& fn) {
  const auto ofSlot = [&](const auto& methods, std::string_view slot, std::string_view kind) {
    for (const auto* m : methods) {
      for (const Counter& c : m->counters)
        fn(c, "--" + std::string(slot) + " " + std::string(m->name), kind);
    }
  };
  ofSlot(gatherMethods(), kGatherSlot.name, "gather");
  ofSlot(compensateMethods(), kCompensateSlot.name, "compensation");
  for (const std::string_view name : VplKinds::names) {
    for (const Counter& c : lightCounters(vplKindNamed(name)))
      fn(c, "--light " + std::string(name), "light");
  }
}

std::vector<Counter> countersOf(const GatherMethod& gather, const CompensateMethod& compensate,
                                VplKind light) {
  std::vector<Counter> counters(gather.counters.begin(), gather.counters.end());
  counters.insert(counters.end(), compensate.counters.begin(), compensate.counters.end());
  if (compensate.oneSize) return counters;  // requireKindCompensated() refuses such light
  const std::span<const Counter> own = lightCounters(light);
  counters.insert(counters.end(), own.begin(), own.end());
  return counters;
}

}  // namespace

std::string counterList() {
  std::string lines;
  forEachCounter([&](const Counter& c, const std::string& method, std::string_view) {
    lines += "\n  " + std::string(c.name) + ": " + std::string(c.help) + ", with " + method;
  });
  return lines;
}

std::vector<Counter> countersOf(const Values& options) {
  const GatherMethod* gather = gatherOf(options);
  return gather ? countersOf(*gather, *compensationOf(options), vplKindOf(options))
                : std::vector<Counter>{};
}

std::span<const Layer> counterLayersOf(const Values& options) {
  using Methods = std::tuple<const GatherMethod*, const CompensateMethod*, VplKind>;
  static const auto all = [] {
    std::map<Methods, std::vector<Layer>> layers;
    for (const GatherMethod* gather : gatherMethods()) {
      for (const CompensateMethod* compensate : compensateMethods()) {
        for (const std::string_view name : VplKinds::names) {
          const VplKind light = vplKindNamed(name);
          for (const Counter& c : countersOf(*gather, *compensate, light)) {
            std::vector<Layer>& own = layers[{gather, compensate, light}];
            own.push_back(counterLayer(c, own.size()));
          }
        }
      }
    }
    return layers;
  }();
  const GatherMethod* gather = gatherOf(options);
  if (!gather) return {};
  const auto own = all.find({gather, compensationOf(options), vplKindOf(options)});
  return own == all.end() ? std::span<const Layer>() : std::span<const Layer>(own->second);
}

void requireOwnCounters(const std::string& layers, std::span<const Layer> own) {
  const std::string list = "," + layers + ",";
  forEachCounter([&](const Counter& c, const std::string& method, std::string_view kind) {
    const std::string name(c.name);
    if (list.find("," + name + ",") == std::string::npos) return;
    if (std::ranges::any_of(own, [&](const Layer& l) { return l.name == c.name; })) return;
    throw UsageError("--layers: '" + name + "' is counted by " + method + " alone; choose that " +
                     std::string(kind) + ", or leave the layer out");
  });
}

}  // namespace bnvpl
