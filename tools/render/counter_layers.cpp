#include "tools/render/counter_layers.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/errors.h"
#include "tools/render/integrator/integrator.h"

namespace bnvpl {

namespace {

// Calls fn(counter, "--gather NAME", "gather") for the counters of all methods.
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
}

std::vector<Counter> countersOf(const GatherMethod& gather, const CompensateMethod& compensate) {
  std::vector<Counter> counters(gather.counters.begin(), gather.counters.end());
  counters.insert(counters.end(), compensate.counters.begin(), compensate.counters.end());
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
  return gather ? countersOf(*gather, *compensationOf(options)) : std::vector<Counter>{};
}

std::span<const Layer> counterLayersOf(const Values& options) {
  using Methods = std::pair<const GatherMethod*, const CompensateMethod*>;
  static const auto all = [] {
    std::map<Methods, std::vector<Layer>> layers;
    for (const GatherMethod* gather : gatherMethods()) {
      for (const CompensateMethod* compensate : compensateMethods()) {
        for (const Counter& c : countersOf(*gather, *compensate)) {
          std::vector<Layer>& own = layers[{gather, compensate}];
          own.push_back(counterLayer(c, own.size()));
        }
      }
    }
    return layers;
  }();
  const GatherMethod* gather = gatherOf(options);
  if (!gather) return {};
  const auto own = all.find({gather, compensationOf(options)});
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
