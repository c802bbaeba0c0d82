// Where the photons of an estimate start.
#pragma once

#include "tools/common/options/option.h"
#include "tools/estimate/estimate.h"
#include "transport/coverage.h"

namespace bnvpl {

inline constexpr auto kEmissionOption =
    inTopic(Topic::Speed,
            choiceOption(
                "emission", "guided", "guided|power",
                "photons start where pilot photons found ways to VPLs, or in proportion to power"));

// Learns from pilot photons, a small share of `photons`, where photons that reach VPLs start.
// The guide minimises the sum over VPLs of variance over flux, with a tenth of the mean flux added
// to each VPL's. Learns nothing with --emission power, and in a merge, which traces no
// photon. `maxBounces`: that of the photons.
LearnedEmission learnPhotonEmission(const EstimateInputs& in, const Coverage& coverage,
                                    const Values& options, unsigned maxBounces, uint64_t photons);

}  // namespace bnvpl
