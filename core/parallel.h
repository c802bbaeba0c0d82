// Deterministic parallel loops with oneTBB: body(i) writes slot i only, and sums have a fixed
// order.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bnvpl {

// Calls body(begin, end) for disjoint ranges of about `grain` indices that cover [0, count).
template <typename Body>
void parallelRanges(size_t count, size_t grain, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain),
                    [&](const tbb::blocked_range<size_t>& r) { body(r.begin(), r.end()); });
}

template <typename Body>
void parallelFor(size_t count, size_t grain, const Body& body) {
  parallelRanges(count, grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(i);
  });
}

// Gathers values[order[i]] for all i.
template <typename T>
std::vector<T> inOrder(std::span<const T> values, std::span<const uint32_t> order) {
  std::vector<T> out(order.size());
  parallelFor(order.size(), 4096, [&](size_t i) { out[i] = values[order[i]]; });
  return out;
}

// Sum of term(i) over [0, count): one partial sum for each fixed chunk, added in chunk order, so
// the result does not depend on the number of threads.
template <typename Term>
double parallelSum(size_t count, const Term& term) {
  constexpr size_t kChunk = 4096;
  std::vector<double> partial((count + kChunk - 1) / kChunk, 0.0);
  parallelFor(partial.size(), 1, [&](size_t chunk) {
    const size_t end = std::min(count, (chunk + 1) * kChunk);
    for (size_t i = chunk * kChunk; i < end; ++i) partial[chunk] += term(i);
  });
  double sum = 0.0;
  for (const double p : partial) sum += p;
  return sum;
}

}  // namespace bnvpl
