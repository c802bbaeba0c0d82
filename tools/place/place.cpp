#include "tools/place/place.h"

#include <array>

namespace bnvpl {

namespace {

// Beyond this vpl-eliminate cannot search.
constexpr double kMaxCount = 0x1p31 - 1;

constexpr std::array kOptions{
    letterFor("-n", countOption("count", "120k", kMaxCount, "",
                                "VPLs to place; at most, where a method keeps its paths whole")),
    seedOption()};

}  // namespace

const StageSpec& placeSpec() {
  static const StageSpec spec{
      "vpl-place",
      kOptions,
      {{"method", "camera", "where VPLs are placed", entriesOf(placeMethods())}}};
  return spec;
}

const PlaceMethod& placeMethod(const Values& options) {
  return methodNamed(placeMethods(), options.text("method"));
}

PlaceResult place(const RayScene& rays, const LightSet& lights, const Values& options,
                  const ProgressFn& progress) {
  PlaceResult result = placeMethod(options).make({rays, lights, progress}, options);
  result.table.sceneHash = rays.scene().contentHash;
  return result;
}

}  // namespace bnvpl
