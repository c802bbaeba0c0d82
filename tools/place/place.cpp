#include "tools/place/place.h"

#include <array>
#include <stdexcept>

#include "tools/place/path_rows.h"

namespace bnvpl {

namespace {

// vpl-eliminate cannot search more candidates.
constexpr double kMaxCount = 0x1p31 - 1;

constexpr std::array kOptions{
    letterFor("-n", countOption("count", "120k", kMaxCount, "",
                                "VPLs to place; --method light may place slightly fewer")),
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

namespace {

// A run that can be interrupted is traced as a single shard, whose rows are kept in memory.
PlaceResult placeInPieces(const PlaceInputs& in, const Values& options, const ProgressFn& progress,
                          Resume resume) {
  std::vector<std::string> records;
  const ShardSink sink{
      [&](std::string_view, uint64_t, std::string_view bytes) { records.emplace_back(bytes); }, {}};
  resume.sink = &sink;
  placeShard(in, options, 0.0, resume, progress);
  const ShardSource source{[&](std::string_view, uint64_t unit) -> std::optional<std::string> {
                             if (unit >= records.size()) return {};
                             return std::move(records[unit]);
                           },
                           {}};
  return joinPlaced(options, in.rays.scene().contentHash, in.views.turns, source,
                    [](uint64_t) { throw std::logic_error("the paths of a whole ended early"); });
}

}  // namespace

PlaceResult place(const PlaceInputs& in, const Values& options, const ProgressFn& progress,
                  const Resume& resume) {
  if (resume.pause) return placeInPieces(in, options, progress, resume);
  const PlaceMethod& method = placeMethod(options);
  PlaceResult result =
      collectRows(in.rays.scene().name(), {options.whole("count"), method.last, in.views.turns},
                  progress, method.make(in, options));
  method.finish(result);
  result.table.sceneHash = in.rays.scene().contentHash;
  return result;
}

PlaceResult placeShard(const PlaceInputs& in, const Values& options, double spare,
                       const Resume& resume, const ProgressFn& progress) {
  return traceShard(in.rays.scene().name(), options.whole("count"), spare, resume, progress,
                    placeMethod(options).make(in, options));
}

PlaceResult joinPlaced(const Values& options, uint64_t sceneHash, const ViewTurns& turns,
                       const ShardSource& source,
                       const std::function<void(uint64_t unit)>& endedEarly) {
  const PlaceMethod& method = placeMethod(options);
  PlaceResult result = joinShards({options.whole("count"), method.last, turns}, source, endedEarly);
  method.finish(result);
  result.table.sceneHash = sceneHash;
  return result;
}

}  // namespace bnvpl
