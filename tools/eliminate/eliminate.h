// The stage vpl-eliminate without files: which candidates stay, and the radius that each stands
// for.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "formats/vpl_table.h"
#include "tools/common/method.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

// Which rows stay.
struct Kept {
  std::vector<uint32_t> rows;  // ascending: path order stays
  std::vector<float> radius;   // of each, world units: it stands for 2 sqrt(3) r^2 of surface
  double rMax = 0.0;           // sqrt(A / (2 sqrt(3) N)), world units
  double area = 0.0;           // A: given or estimated, world units squared
  std::vector<float> weight;   // what each row's flux is multiplied with; empty: 1
};

struct EliminateInputs {
  const VplTable& candidates;
  // Null unless the method needs the scene.
  const RayScene* rays = nullptr;
  const LightSet* lights = nullptr;
  const ProgressFn& progress;
};

struct EliminateMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  Kept (*make)(const EliminateInputs&, const Values&);
  VplStage takes = VplStage::Candidates;  // stage of the table that it chooses from; it stays of it
  bool needsScene = false;
};
std::span<const EliminateMethod* const> eliminateMethods();  // one for each folder beside this file

// count, method, and the methods' own.
const StageSpec& eliminateSpec();
const EliminateMethod& eliminateMethod(const Values& options);

struct EliminateResult {
  VplTable table;  // of stage Eliminated, or Lit where the method takes lit rows
  double rMax = 0.0, area = 0.0;
};

// Keeps rows of `candidates`, which are of the stage that the method takes; unit normals. A pure
// function: any number of threads gives the same bytes. Throws InputError when count is 0 or above
// the number of candidates, UsageError when the method needs a scene and there is none.
EliminateResult eliminate(const VplTable& candidates, const Values& options,
                          const RayScene* rays = nullptr, const LightSet* lights = nullptr,
                          const ProgressFn& progress = {});

}  // namespace bnvpl
