// Runs code by a number of threads, which may exceed that of the machine's processors.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace bnvpl::test {

// The result of run(). An arena of its own is what lets more threads than processors take part.
template <typename Run>
auto withThreads(size_t threads, const Run& run) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  return arena.execute(run);
}

}  // namespace bnvpl::test
