// --view, --camera and --view-shares of vpl-place: the views that VPLs are placed for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/common/stage/scene_options.h"
#include "tools/place/place.h"

namespace bnvpl {

inline constexpr TextOption kViewSharesOption =
    textOption("view-shares", "", "N,...",
               "relative number of camera paths for each view; equal unless given");

// "2,1" -> 2, 1. Throws UsageError.
std::vector<uint64_t> parseViewShares(const std::string& text);

// The views that `options` name; their files become the scene's. Empty `shares` are equal ones.
// Throws UsageError where method or shares do not fit the views.
PlaceViews placeViews(const SceneOptions& options, std::vector<uint64_t> shares,
                      const PlaceMethod& method, Scene& scene);

// Notes one view in the record of a run, or all in the order of their turns.
void recordViews(const PlaceViews& of, Json& record);

}  // namespace bnvpl
