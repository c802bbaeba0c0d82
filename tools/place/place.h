// The stage vpl-place without files: where VPLs might stand.
#pragma once

#include <functional>

#include "core/progress.h"
#include "core/resume.h"
#include "formats/vpl_table.h"
#include "scene/scene.h"
#include "tools/common/method.h"
#include "tools/place/view_turns.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

struct PlaceResult {
  VplTable table;      // of stage Candidates or Lit, as the method says
  uint64_t rows = 0;   // of the table, or handed to a shard's sink
  uint64_t paths = 0;  // traced until the count was reached
  uint64_t rays = 0;
  uint64_t nonFinite = 0;  // vertices or photons left out because a value was NaN or infinite
  // How the traced paths ended: in the void, on a surface that reflects nothing, or at full depth.
  uint64_t escaped = 0, absorbed = 0, complete = 0;
  std::vector<uint64_t> rowsOfView;  // of the table; empty where there is one view
};

// Whose surroundings VPLs are placed for; all of one scene.
struct PlaceViews {
  explicit PlaceViews(const Scene& scene) : views{{"", scene.camera, scene.film}} {}
  PlaceViews(std::vector<View> of, std::vector<uint64_t> shares)
      : views(std::move(of)), turns(std::move(shares)) {}
  std::vector<View> views;
  ViewTurns turns;
};

struct PlaceInputs {
  const RayScene& rays;
  const LightSet& lights;
  const PlaceViews& views;
};

// Traces the paths [begin, begin + kPathsPerChunk) into a chunk without rows: path_rows.h. Called
// from many threads.
struct PathRows;
using TracePaths = std::function<void(uint64_t begin, PathRows& chunk)>;

// Cut: the last path may end in the middle, and there are `count` rows exactly. Whole: the path
// that would exceed the count is left out, for its other rows would weigh as much as all of it.
enum class LastPath { Cut, Whole };

// Rows are in path order: the first N of 2N are those of N.
struct PlaceMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  TracePaths (*make)(const PlaceInputs&, const Values&);
  void (*finish)(PlaceResult&);  // the stage, and the columns that follow from all rows together
  LastPath last = LastPath::Cut;
  bool needsLight = false;  // a scene in which nothing shines is refused
  bool forView = true;      // the rows depend on camera and film
};
std::span<const PlaceMethod* const> placeMethods();  // one for each folder beside this file

// count, seed, method, and the methods' own.
const StageSpec& placeSpec();
const PlaceMethod& placeMethod(const Values& options);

// A pure function of the scene, its views and the options: any number of threads, and any
// interruption that `resume` mends, gives the same bytes. Throws InputError when the scene yields
// too few within a bounded effort. `progress` counts VPLs.
PlaceResult place(const PlaceInputs& in, const Values& options, const ProgressFn& progress = {},
                  const Resume& resume = {});

// The paths of resume's shard, whose rows go to the sink; the result has none. Nobody knows before
// how many paths give the count: a shard ends with its part of the rows and six standard deviations
// more, for those that find fewer, and with `spare` of its part besides.
PlaceResult placeShard(const PlaceInputs& in, const Values& options, double spare,
                       const Resume& resume, const ProgressFn& progress = {});
// What place() gives, from the rows of all shards. `endedEarly` is called with the first unit that
// is missing where they do not suffice, and throws.
PlaceResult joinPlaced(const Values& options, uint64_t sceneHash, const ViewTurns& turns,
                       const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly);

}  // namespace bnvpl
