// What a cluster of the light tree can, and what it will likely, send to a point.
#pragma once

#include "scene/bsdf.h"
#include "tools/render/light_tree.h"

namespace bnvpl {

// Upper bound on the error of taking one VPL for the whole cluster, summed over the channels;
// visibility counts as full (Walter et al. 2005, section 4.1). 0 for a leaf.
float errorBound(const LightNode& n, const Bsdf& bsdf);

// The same with the distance to expect of its VPLs rather than the nearest: most of a cluster is
// further away than its nearest corner. 0 only where nothing can arrive.
float likelyContribution(const LightNode& n, const Bsdf& bsdf);

}  // namespace bnvpl
