// The stage vpl-eliminate without its files: selects candidates and gives each its radius.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "formats/vpl/vpl_table.h"
#include "tools/common/stage/method.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"

namespace bnvpl {

inline constexpr WholeOption kEliminateCountOption =
    inTopic(Topic::Main, letterFor("-n", countOption("count", "", 0x1p53, "", "VPLs to keep")));

// Points of the image at which a method measures VPLs, where it does.
inline constexpr OptionKey<uint64_t> kCameraPointsKey{"camera-points"};

// Rows that a method keeps.
struct EliminateResult {
  std::vector<uint32_t> rows;  // ascending, so they stay in path order
  std::vector<float> radius;   // one per row, world units: it stands for 2 sqrt(3) r^2 of surface
  double rMax = 0.0;           // sqrt(A / (2 sqrt(3) N)), world units
  double area = 0.0;           // A: given or estimated, world units squared
  std::vector<float> weight;   // factor of each row's flux; empty: 1
};

struct EliminateInputs {
  const VplTable& candidates;
  // May be null unless the method needs the scene.
  const Accelerator* accel = nullptr;
  const LightSet* lights = nullptr;
  const ProgressFn& progress;
};

struct EliminateMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  EliminateResult (*run)(const EliminateInputs&, const Values&);
  VplStage takes = VplStage::Candidates;  // stage of the input table
  bool needsScene = false;
  std::string_view madeBy = "vpl-place";  // the command that makes the input table
  double bytesPerCandidate = 120;         // a lower bound of the memory; measured: 140 to 150
};
// Defined in the build folder by cmake/Methods.cmake, from the folders beside this file.
std::span<const EliminateMethod* const> eliminateMethods();

// Throws UsageError unless a scene is given exactly where the method needs one.
void requireSceneAsNeeded(const EliminateMethod& method, bool given);

// Options of the stage: count, method, and those of each method.
const StageSpec& eliminateSpec();
const EliminateMethod& eliminateMethod(const Values& options);

// Keeps rows of `candidates`, whose stage is the one that the method takes; normals have unit
// length. A pure function: the number of threads does not change a byte. Throws InputError if count
// is above the number of candidates, and UsageError unless there is a scene exactly where the
// method needs one. The stage of the result is Eliminated, or Lit if the method takes lit rows.
VplTable eliminate(const VplTable& candidates, const Values& options,
                   const Accelerator* accel = nullptr, const LightSet* lights = nullptr,
                   const ProgressFn& progress = {});

}  // namespace bnvpl
