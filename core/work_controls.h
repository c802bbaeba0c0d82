// Long work in independent units that can be interrupted between units and resumed with the same
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

#include "core/cost_trial.h"
#include "core/errors.h"
#include "core/parallel.h"
#include "core/shard.h"

namespace bnvpl {

// A caller's instructions to a stage. By default it does all units from the start. Of `sink`,
// `source` and `trial`, all borrowed, at most one is set. `pause` needs `save`.
struct WorkControls {
  std::string state;                             // argument of an earlier save(), or empty
  std::function<bool()> pause;                   // called from any thread; true: begin no unit
  std::function<void(const std::string&)> save;  // called between units; may throw to end the work

  Shard shard = {};                     // units to do
  const ShardSink* sink = nullptr;      // receives the units' results; the stage returns none
  const ShardSource* source = nullptr;  // results of all units, computed elsewhere: none is done
  CostTrial* trial = nullptr;           // set by --estimate
  double trialScale = 1.0;  // units of the whole work that one unit of the trial stands for
};

// Marks each unit 0 if it is to be done here, and kElsewhere if it belongs to another shard.
inline constexpr uint8_t kElsewhere = 2;
inline std::vector<uint8_t> unitsToDo(size_t count, const Shard& shard) {
  std::vector<uint8_t> done(count);
  for (size_t i = 0; i < count; ++i) done[i] = shard.has(i) ? 0 : kElsewhere;
  return done;
}

// Calls unit(i) for each i with done[i] == 0, and sets done[i] to 1. When controls.pause() returns
// true, the running units end, and controls.save(state()) is called unless no unit is left. The
// result must not depend on which units ran together, nor on their order: the k-th is order(k).
template <typename Unit, typename State, typename Order = std::identity>
void forUnitsLeft(std::vector<uint8_t>& done, const WorkControls& controls, const Unit& unit,
                  const State& state, const Order& order = {}) {
  for (;;) {
    std::atomic<bool> paused{false};
    parallelFor(done.size(), 1, [&](size_t k) {
      const size_t i = order(k);
      if (done[i] || paused.load(std::memory_order_relaxed)) return;
      {
        const CostTrial::Unit timed(controls.trial, controls.trialScale);
        unit(i);
      }
      done[i] = 1;
      // Checked after the unit, so that every round makes progress however frequent pauses are.
      if (controls.pause && controls.pause()) paused.store(true, std::memory_order_relaxed);
    });
    if (std::find(done.begin(), done.end(), 0) == done.end()) return;
    controls.save(state());
  }
}

// State as bytes: concatenated arrays of plain values, which are read in the order and with the
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

// Reads the record of one unit, which consists of `array` alone. Throws InputError if it is missing
// or has another size.
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
