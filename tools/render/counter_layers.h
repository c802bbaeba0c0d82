// What the methods of an image count besides clusters and shadow rays, and the layers that show it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/common/options/option.h"
#include "tools/render/film/layers.h"

namespace bnvpl {

// Lines of --help for the layers of all methods' own counters.
std::string counterList();
// Counters of a run: those of its gather, of its compensation, and of its kind of light.
std::vector<Counter> countersOf(const Values& options);
// Their layers.
std::span<const Layer> counterLayersOf(const Values& options);
// Throws UsageError if `layers`, separated by commas, names a counter of another method.
void requireOwnCounters(const std::string& layers, std::span<const Layer> own);

}  // namespace bnvpl
