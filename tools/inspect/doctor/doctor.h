// vpl-inspect doctor: what makes images of a scene dark, slow or wrong, and what to change.
#pragma once

#include <string>

#include "tools/common/files/json_text.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"

namespace bnvpl {

// Counts of the pipeline by default: pipelines/quality.mk.
inline constexpr double kUsualVpls = 3000.0, kUsualPhotons = 10e6, kUsualSpp = 16.0;
// Rates of pipelines/cost_model.json, CPU seconds on one core.
inline constexpr double kSecondsPerPhoton = 1.994e-06, kSecondsPerSample = 2.231e-06,
                        kSecondsPerSampleLog2Vpls = 5.796e-07,
                        kSecondsPerSampleLog2Triangles = 1.373e-06;

// {"lights": [{"light", "power_W", "shines", "meets_at_once", "leaves", "reaches_view"}],
//  "view": {"depth", "open", "behind", "inside"}, "vpls": {...}, "cost": {...},
//  "findings": [{"what", "change"}]}
// Shares are of 0 to 1, lengths in scene units. The same scene gives the same result.
Json diagnose(const Accelerator& accel, const LightSet& lights);

// The diagnosis for people.
std::string doctorText(const Json& diagnosis);

}  // namespace bnvpl
