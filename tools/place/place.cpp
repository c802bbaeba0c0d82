#include "tools/place/place.h"

#include <array>
#include <stdexcept>

#include "tools/place/indirect_share.h"
#include "tools/place/path_rows.h"

namespace bnvpl {

namespace {

constexpr auto kOptions = optionTable(kPlaceCountOption, kSeedOption);

}  // namespace

const StageSpec& placeSpec() {
  static const StageSpec spec{
      "vpl-place",
      kOptions,
      {{"method", "camera", "where VPLs are placed", entriesOf(placeMethods())}},
      {{"candidates for the view of the scene's camera",
        "vpl-place scenes/cornell/scene.toml -o candidates.vpl"},
       {"fewer candidates, for a quick look, and always the same",
        "vpl-place scene.glb -o candidates.vpl -n 30k --seed 7"},
       {"candidates for two cameras of the scene",
        "vpl-place scene.pbrt -o candidates.vpl --camera 1 --camera 2"}}};
  return spec;
}

const PlaceMethod& placeMethod(const Values& options) {
  return methodNamed(placeMethods(), options[kMethodSlot]);
}

namespace {

double indirectShareFor(const PlaceInputs& in, const Values& options) {
  return placeMethod(options).forView ? indirectShare(in, options[kSeedOption]) : 1.0;
}

PlaceResult joinRows(const Values& options, const ViewTurns& turns, const ShardSource& source,
                     const std::function<void(uint64_t unit)>& endedEarly) {
  const PlaceMethod& method = placeMethod(options);
  PlaceResult result =
      joinShards({options[kPlaceCountOption], method.last, turns, method.makes == VplStage::Lit},
                 source, endedEarly);
  method.finish(result);
  return result;
}

PlaceResult traceRows(const PlaceInputs& in, const Values& options, double spare,
                      const WorkControls& controls, const ProgressFn& progress) {
  return traceShard(in.accel.scene().name(), options[kPlaceCountOption], spare, controls, progress,
                    placeMethod(options).make(in, options));
}

// A run that can be interrupted is traced as a single shard, whose rows are kept in memory.
PlaceResult placeResumable(const PlaceInputs& in, const Values& options, const ProgressFn& progress,
                           WorkControls controls) {
  std::vector<std::string> records;
  const ShardSink sink{
      [&](std::string_view, uint64_t, std::string_view bytes) { records.emplace_back(bytes); }, {}};
  controls.sink = &sink;
  traceRows(in, options, 0.0, controls, progress);
  const ShardSource source{[&](std::string_view, uint64_t unit) -> std::optional<std::string> {
                             if (unit >= records.size()) return {};
                             return std::move(records[unit]);
                           },
                           {}};
  return joinRows(options, in.views.turns, source,
                  [](uint64_t) { throw std::logic_error("the paths of a whole ended early"); });
}

PlaceResult placeUninterrupted(const PlaceInputs& in, const Values& options,
                               const ProgressFn& progress) {
  const PlaceMethod& method = placeMethod(options);
  PlaceResult result = collectRows(in.accel.scene().name(),
                                   {options[kPlaceCountOption], method.last, in.views.turns},
                                   progress, method.make(in, options));
  method.finish(result);
  return result;
}

}  // namespace

PlaceResult place(const PlaceInputs& in, const Values& options, const ProgressFn& progress,
                  const WorkControls& controls) {
  PlaceResult result = controls.pause ? placeResumable(in, options, progress, controls)
                                      : placeUninterrupted(in, options, progress);
  result.table.indirectShare = indirectShareFor(in, options);
  result.table.sceneHash = in.accel.scene().contentHash;
  return result;
}

PlaceResult placeShard(const PlaceInputs& in, const Values& options, double spare,
                       const WorkControls& controls, const ProgressFn& progress) {
  PlaceResult counts = traceRows(in, options, spare, controls, progress);
  if (placeMethod(options).forView && controls.shard.has(0))
    giveIndirectShare(*controls.sink, indirectShareFor(in, options));
  return counts;
}

PlaceResult joinPlaced(const Values& options, uint64_t sceneHash, const ViewTurns& turns,
                       const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly) {
  PlaceResult result = joinRows(options, turns, source, endedEarly);
  if (placeMethod(options).forView) result.table.indirectShare = takeIndirectShare(source);
  result.table.sceneHash = sceneHash;
  return result;
}

}  // namespace bnvpl
