#include "tools/render/counter_layers.h"

#include <algorithm>
#include <map>
#include <vector>

#include "core/errors.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"

namespace bnvpl {

std::string counterList() {
  std::string lines;
  for (const GatherMethod* m : gatherMethods()) {
    for (const Counter& c : m->counters) {
      lines += "\n  " + std::string(c.name) + ": " + std::string(c.help) + ", with --gather " +
               std::string(m->name);
    }
  }
  return lines;
}

std::span<const Layer> counterLayersOf(const Values& options) {
  static const auto all = [] {
    std::map<std::string_view, std::vector<Layer>> layers;
    for (const GatherMethod* m : gatherMethods()) {
      for (size_t k = 0; k < m->counters.size(); ++k)
        layers[m->name].push_back(counterLayer(m->counters[k], k));
    }
    return layers;
  }();
  if (!options.has(kGatherSlot)) return {};
  const auto own = all.find(options[kGatherSlot]);
  return own == all.end() ? std::span<const Layer>() : std::span<const Layer>(own->second);
}

void requireOwnCounters(const std::string& layers, std::span<const Layer> own) {
  const std::string list = "," + layers + ",";
  for (const GatherMethod* m : gatherMethods()) {
    for (const Counter& c : m->counters) {
      const std::string name(c.name);
      if (list.find("," + name + ",") == std::string::npos) continue;
      if (std::ranges::any_of(own, [&](const Layer& l) { return l.name == c.name; })) continue;
      throw UsageError("--layers: '" + name + "' is counted by --gather " + std::string(m->name) +
                       " alone; choose that gather, or leave the layer out");
    }
  }
}

}  // namespace bnvpl
