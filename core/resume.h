// Long work in independent units that can be stopped between them and continued, with the same
// result.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/cost_probe.h"
#include "core/errors.h"
#include "core/parallel.h"
#include "core/shard.h"

namespace bnvpl {

// What a stage is told by its caller. The default: from the start to the end.
struct Resume {
  std::string state;                             // of earlier work, as save() got it, or empty
  std::function<bool()> pause;                   // from any thread: whether to begin no other unit
  std::function<void(const std::string&)> save;  // between units; may throw to end the work

  Shard shard = {};                     // the units to do
  const ShardSink* sink = nullptr;      // where what they brought goes, in place of a result
  const ShardSource* source = nullptr;  // what all units brought, elsewhere
  CostProbe* probe = nullptr;           // set by --estimate
  double times = 1.0;                   // a unit of the probe stands for so many
};

// Of so many units, those to do: 0, or kElsewhere for those of other shards.
inline constexpr uint8_t kElsewhere = 2;
inline std::vector<uint8_t> unitsToDo(size_t count, const Shard& shard) {
  std::vector<uint8_t> done(count);
  for (size_t i = 0; i < count; ++i) done[i] = shard.has(i) ? 0 : kElsewhere;
  return done;
}

// Calls unit(i) for each i with done[i] == 0 and sets it. Whenever resume.pause() says so, the
// units that were begun end, and resume.save(state()) is called unless nothing is left. The result
// must not depend on which units ran together.
template <typename Unit, typename State>
void forUnitsLeft(std::vector<uint8_t>& done, const Resume& resume, const Unit& unit,
                  const State& state) {
  for (;;) {
    std::atomic<bool> paused{false};
    parallelFor(done.size(), 1, [&](size_t i) {
      if (done[i] || paused.load(std::memory_order_relaxed)) return;
      {
        const CostProbe::Unit timed(resume.probe, resume.times);
        unit(i);
      }
      done[i] = 1;
      // Asked after the unit, so that every round gets on, however short the time between pauses.
      if (resume.pause && resume.pause()) paused.store(true, std::memory_order_relaxed);
    });
    if (std::find(done.begin(), done.end(), 0) == done.end()) return;
    resume.save(state());
  }
}

// State as bytes: arrays of plain values one behind the other, read back in the order and with the
// lengths in which they were written.
template <typename Array>
void appendArray(std::string& bytes, const Array& array) {
  const auto view = std::as_bytes(std::span(array));
  bytes.append(reinterpret_cast<const char*>(view.data()), view.size());
}

template <typename Array>
void takeArray(std::string_view& bytes, Array&& array) {
  const auto view = std::as_writable_bytes(std::span(array));
  if (bytes.size() < view.size())
    throw InputError("the state of the checkpoint is too short; delete it and start again");
  if (!view.empty()) std::memcpy(view.data(), bytes.data(), view.size());
  bytes.remove_prefix(view.size());
}

// What a shard brought of one unit, which is nothing but `array`.
template <typename Array>
void takeRecord(const ShardSource& source, std::string_view work, uint64_t unit, Array&& array) {
  const auto bytes = source.record(work, unit);
  const size_t size = std::as_bytes(std::span(array)).size();
  if (!bytes || bytes->size() != size) {
    throw InputError("the shards hold no unit " + std::to_string(unit) + " of the " +
                     std::string(work) + "; make them again");
  }
  if (size > 0) std::memcpy(std::as_writable_bytes(std::span(array)).data(), bytes->data(), size);
}
template <typename Array>
void giveRecord(const ShardSink& sink, std::string_view work, uint64_t unit, const Array& array) {
  std::string bytes;
  appendArray(bytes, array);
  sink.record(work, unit, bytes);
}

inline void requireAllTaken(std::string_view bytes) {
  if (!bytes.empty())
    throw InputError("the state of the checkpoint is too long; delete it and start again");
}

}  // namespace bnvpl
