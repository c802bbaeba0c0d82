// Layers of what a gather counts besides clusters and shadow rays.
#pragma once

#include <span>
#include <string>

#include "tools/common/options/option.h"
#include "tools/render/film/layers.h"

namespace bnvpl {

// Lines of --help for the layers of all gathers' own counters.
std::string counterList();
// Layers of the counters of the gather of a run.
std::span<const Layer> counterLayersOf(const Values& options);
// Throws UsageError if `layers`, separated by commas, names a counter of another gather.
void requireOwnCounters(const std::string& layers, std::span<const Layer> own);

}  // namespace bnvpl
