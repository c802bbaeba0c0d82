// Pixel filters: how much the light at a place of the film counts in a pixel. Camera rays of a
// pixel are spread like its filter (Ernst, Stamminger & Greiner, Filter importance sampling, 2006;
// pbrt-v4, section 8.8), so that each sample belongs to one pixel.
#pragma once

#include <cstdint>
#include <memory>

#include "core/random.h"
#include "scene/filter_spec.h"

namespace bnvpl {

class PixelFilter {
 public:
  using Kind = FilterKind;

  // A place on the film relative to the pixel's corner, in pixels, and the factor of the light
  // there. Its mean is 1; it is 1 for filters that are nowhere negative.
  struct Sample {
    Point2 at;
    float weight = 1.0f;
  };
  // Which of the samples that are averaged this is. A filter with negative lobes gives a fixed
  // number of them a negative weight, so that the weights of all add up to their number. `key`
  // decides which ones. With less than two samples the sign is random. `weighted`: whether the
  // sample gets its weight; pilots, which measure noise, take 1 for all.
  struct SampleOfSet {
    uint64_t index = 0, count = 0, key = 0;
    bool weighted = true;
  };

  PixelFilter() = default;  // the box over the pixel, of radius 1/2
  PixelFilter(Kind kind, float radius);

  // Whether the filter of a pixel is the pixel itself.
  bool isPixel() const { return !axis_; }
  float radius() const { return isPixel() ? 0.5f : axisRadius(); }
  // Value at a place relative to the pixel's centre, 1/pixel^2; its integral is 1.
  float density(float x, float y) const;
  // Mean of the squared weights of many samples: 1 for filters that are nowhere negative. That of
  // two samples of a filter with negative lobes is up to 1.8 times as large.
  float squaredWeight() const { return isPixel() ? 1.0f : axisSquaredWeight(); }
  // Maps the unit square to places with a density proportional to |density()|.
  Sample sample(Point2 u, const SampleOfSet& which) const {
    Sample out = isPixel() ? Sample{u} : samplePlaces(u, which);
    if (!which.weighted) out.weight = 1.0f;
    return out;
  }
  Sample sample(Point2 u) const { return sample(u, {}); }

 private:
  struct Axis;
  float axisRadius() const;
  float axisSquaredWeight() const;
  Sample samplePlaces(Point2 u, const SampleOfSet& which) const;

  std::shared_ptr<const Axis> axis_;  // the filter along x and along y; null: the pixel's box
};

}  // namespace bnvpl
