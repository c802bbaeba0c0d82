// The stage vpl-place without its files: makes candidates, the places where VPLs may stand.
#pragma once

#include <functional>

#include "core/progress.h"
#include "core/work_controls.h"
#include "formats/vpl/vpl_table.h"
#include "scene/scene.h"
#include "tools/common/stage/method.h"
#include "tools/place/view_turns.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"

namespace bnvpl {

struct PlaceResult {
  VplTable table;      // its stage is Candidates or Lit, depending on the method
  uint64_t rows = 0;   // in the table, or given to a shard's sink
  uint64_t paths = 0;  // traced until the count was reached
  uint64_t rays = 0;
  uint64_t nonFinite = 0;  // vertices or photons left out because a value was NaN or infinite
  // Numbers of paths that left the scene, were absorbed, or reached full depth.
  uint64_t escaped = 0, absorbed = 0, complete = 0;
  std::vector<uint64_t> rowsOfView;  // rows found from each view; empty if there is only one view
};

// Views of one scene that VPLs are placed for.
struct PlaceViews {
  explicit PlaceViews(const Scene& scene) : views{{"", scene.camera, scene.film}} {}
  PlaceViews(std::vector<View> of, std::vector<uint64_t> shares)
      : views(std::move(of)), turns(std::move(shares)) {}
  std::vector<View> views;
  ViewTurns turns;
};

// vpl-eliminate cannot search more candidates.
inline constexpr double kMaxPlaced = 0x1p31 - 1;
inline constexpr WholeOption kPlaceCountOption =
    inTopic(Topic::Main,
            letterFor("-n", countOption("count", "120k", kMaxPlaced, "",
                                        "VPLs to place; --method light may place slightly fewer")));

struct PlaceInputs {
  const Accelerator& accel;
  const LightSet& lights;
  const PlaceViews& views;
};

struct PathRows;
// Traces the paths [begin, begin + kPathsPerChunk) into an empty chunk (path_rows.h). Must be
// thread-safe.
using TracePaths = std::function<void(uint64_t begin, PathRows& chunk)>;

// Cut: there are exactly `count` rows, and the last path may have lost some. Whole: a path that
// would exceed the count is left out, since rows with flux are unbiased only if every path keeps
// all of its rows.
enum class LastPath { Cut, Whole };

// Rows are in path order, so the first N of 2N rows are those of a run for N.
struct PlaceMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  TracePaths (*make)(const PlaceInputs&, const Values&);
  void (*finish)(PlaceResult&);  // sets the stage and the columns that depend on all rows together
  LastPath last = LastPath::Cut;
  bool needsLight = false;                // whether a scene without lights is refused
  bool forView = true;                    // whether the rows depend on camera and film
  VplStage makes = VplStage::Candidates;  // the stage that `finish` gives the table
};
// Defined in the build folder by cmake/Methods.cmake, from the folders beside this file.
std::span<const PlaceMethod* const> placeMethods();

// Options of the stage: count, seed, method, and those of each method.
const StageSpec& placeSpec();
const PlaceMethod& placeMethod(const Values& options);

// A pure function of the scene, its views and the options: neither threads nor interruptions change
// a byte. Throws InputError where the scene yields too few VPLs in maxChunksFor(count) chunks of
// paths. `progress` counts VPLs.
PlaceResult place(const PlaceInputs& in, const Values& options, const ProgressFn& progress = {},
                  const WorkControls& controls = {});

// Traces the paths of the shard in `controls` and gives their rows to its sink; the result has only
// counts. How many paths yield the count is not known beforehand. So a shard goes on until it has
// its part of the rows, multiplied by 1 + `spare`, and six standard deviations more, to make up for
// shards that find fewer.
PlaceResult placeShard(const PlaceInputs& in, const Values& options, double spare,
                       const WorkControls& controls, const ProgressFn& progress = {});
// Joins the rows of all shards to the result of place(). If there are too few, `endedEarly` is
// called with the first unit that is missing; it must throw.
PlaceResult joinPlaced(const Values& options, uint64_t sceneHash, const ViewTurns& turns,
                       const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly);

}  // namespace bnvpl
