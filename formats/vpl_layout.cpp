#include "formats/vpl_layout.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <string_view>

namespace bnvpl {
namespace {

constexpr float kUnitLengthTolerance = 1e-3f;  // float32 normals of far smaller error still pass
constexpr float kAlbedoTolerance = 1e-4f;      // rounding of 8-bit textures and of products

template <size_t Size>
std::array<char, Size> padded(std::string_view text) {
  std::array<char, Size> result{};
  std::copy(text.begin(), text.end(), result.begin());
  return result;
}

// The first row for which problemOf(value) is not null.
template <typename T, typename ProblemOf>
std::optional<BadValue> findIn(const std::vector<T>& values, size_t column,
                               const ProblemOf& problemOf) {
  for (size_t row = 0; row < values.size(); ++row) {
    if (const char* problem = problemOf(values[row])) return BadValue{column, row, problem};
  }
  return std::nullopt;
}

constexpr const char* kNotFinite = "not a finite number";

const char* positionProblem(Vec3 p) { return isFinite(p) ? nullptr : kNotFinite; }
const char* normalProblem(Vec3 n) {
  if (!isFinite(n)) return kNotFinite;
  return std::fabs(length(n) - 1.0f) <= kUnitLengthTolerance ? nullptr : "not of unit length";
}
const char* albedoProblem(Vec3 a) {
  if (!isFinite(a)) return kNotFinite;
  const float low = std::min({a.x, a.y, a.z}), high = std::max({a.x, a.y, a.z});
  return low >= -kAlbedoTolerance && high <= 1.0f + kAlbedoTolerance ? nullptr
                                                                     : "not between 0 and 1";
}
const char* radiusProblem(float r) {
  if (!std::isfinite(r)) return kNotFinite;
  return r > 0.0f ? nullptr : "not above 0";
}
const char* fluxProblem(Vec3 f) {
  if (!isFinite(f)) return kNotFinite;
  return std::min({f.x, f.y, f.z}) >= 0.0f ? nullptr : "negative";
}
const char* relativeErrorProblem(float e) {
  if (!std::isfinite(e)) return kNotFinite;
  return e >= 0.0f ? nullptr : "negative";
}

}  // namespace

size_t columnCount(VplStage stage) {
  return static_cast<size_t>(
      std::count_if(kVplColumns.begin(), kVplColumns.end(),
                    [&](const VplColumnInfo& column) { return column.since <= stage; }));
}

uint64_t rowBytes(VplStage stage) {
  uint64_t bytes = 0;
  for (size_t i = 0; i < columnCount(stage); ++i) bytes += kVplColumns[i].rowBytes();
  return bytes;
}

VplLayout makeLayout(VplStage stage, uint64_t count, uint64_t provenanceBytes) {
  VplLayout layout;
  const size_t columns = columnCount(stage);
  layout.provenanceOffset = sizeof(VplHeader) + columns * sizeof(VplColumnEntry);
  uint64_t offset = alignUp(layout.provenanceOffset + provenanceBytes);
  for (size_t i = 0; i < columns; ++i) {
    const VplColumnInfo& column = kVplColumns[i];
    const uint64_t bytes = count * column.rowBytes();
    layout.directory.push_back({padded<24>(column.name), column.type, column.components, offset,
                                bytes, padded<16>(column.unit)});
    offset = alignUp(offset + bytes);
  }
  layout.endMarkOffset = offset;
  layout.fileBytes = offset + kVplEndMark.size();
  return layout;
}

std::optional<BadValue> findBadValue(const VplTable& table) {
  auto bad = findIn(table.position, 0, positionProblem);
  if (!bad) bad = findIn(table.normal, 1, normalProblem);
  if (!bad) bad = findIn(table.albedo, 2, albedoProblem);
  if (!bad) bad = findIn(table.radius, 4, radiusProblem);
  if (!bad) bad = findIn(table.flux, 5, fluxProblem);
  if (!bad) bad = findIn(table.relativeError, 7, relativeErrorProblem);
  if (!bad) bad = findIn(table.emitPosition, 8, positionProblem);
  if (!bad) bad = findIn(table.emitNormal, 9, normalProblem);
  if (!bad) bad = findIn(table.firstBounceFlux, 10, fluxProblem);
  for (size_t row = 0; !bad && row < table.firstBounceFlux.size(); ++row) {
    const Vec3 rest = table.flux[row] - table.firstBounceFlux[row];
    if (std::min({rest.x, rest.y, rest.z}) < 0.0f) bad = BadValue{10, row, "above the flux"};
  }
  return bad;
}

uint64_t hashPieces(const std::vector<Bytes>& pieces) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  for (const Bytes& piece : pieces) XXH3_64bits_update(state.get(), piece.data(), piece.size());
  return XXH3_64bits_digest(state.get());
}

bool isMeasure(double value) { return std::isfinite(value) && value >= 0.0; }

}  // namespace bnvpl
