#include "images/comparison.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {
namespace {

// Measures of one quantity. Squared errors may be negative with two halves of the reference.
struct Measures {
  double meanA = 0, meanB = 0, squared = 0, relative = 0, smape = 0;
};

void addMeans(const ImagePair& pair, const Quantity& quantity, Measures& m) {
  m.meanA = meanOver(pair, pair.a, quantity);
  m.meanB = meanOver(pair, pair.b, quantity);
}

void addErrors(const ImagePair& pair, const Quantity& quantity, double epsilon, Measures& m) {
  m.squared = meanSquaredError(pair, quantity);
  m.relative = relativeMse(pair, quantity, epsilon);
  m.smape = symmetricError(pair, quantity);
}

Comparison::Channel channelFrom(const std::string& name, const Measures& m) {
  return {name,   m.meanA, m.meanB, std::sqrt(std::max(0.0, m.squared)), std::max(0.0, m.relative),
          m.smape};
}

void measureChannels(const ImagePair& pair, double epsilon, Comparison& c) {
  const size_t channels = pair.b.data.size();
  std::vector<Measures> measures(channels);
  for (size_t k = 0; k < channels; ++k) {
    addMeans(pair, channelOf(pair.b, k), measures[k]);
    c.meanA += measures[k].meanA / double(channels);
    c.meanB += measures[k].meanB / double(channels);
  }
  c.epsilon = epsilon * c.meanB * c.meanB;
  double squared = 0.0, relative = 0.0, smape = 0.0;
  for (size_t k = 0; k < channels; ++k) {
    addErrors(pair, channelOf(pair.b, k), c.epsilon, measures[k]);
    squared += measures[k].squared;
    relative += measures[k].relative;
    smape += measures[k].smape;
    c.channels.push_back(channelFrom(pair.b.channels[k], measures[k]));
  }
  c.rmseBelowNoise = squared < 0.0;
  c.relMseBelowNoise = relative < 0.0;
  c.mse = std::max(0.0, squared / double(channels));
  c.rmse = std::sqrt(c.mse);
  c.relMse = std::max(0.0, relative / double(channels));
  c.smape = smape / double(channels);
}

}  // namespace

Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, double epsilon, const Layer* second, const Mask& mask) {
  const ImagePair pair = makePair(fileA, a, fileB, b, second, mask);
  Comparison c;
  measureChannels(pair, epsilon, c);
  if (b.isColour()) {
    Measures m;
    addMeans(pair, luminanceQuantity(), m);
    addErrors(pair, luminanceQuantity(), c.epsilon, m);
    c.luminance = channelFrom("luminance", m);
  }
  c.worstPixel = worstPixel(pair);
  if (!mask.weights.empty()) c.maskPixels = pair.weight;
  return c;
}

void addFlip(const FlipMaps& maps, const Mask& mask, Comparison& c) {
  c.flip = Comparison::Flip{weightedMean(maps.ldr, mask),
                            weightedMean(maps.hdr, mask),
                            maps.ppd,
                            maps.exposureEv,
                            maps.startEv,
                            maps.stopEv,
                            maps.exposures};
}

}  // namespace bnvpl
