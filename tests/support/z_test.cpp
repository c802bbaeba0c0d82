#include "tests/support/z_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "formats/image/exr_io.h"
#include "tests/support/student_t.h"

namespace bnvpl::test {
namespace {

constexpr std::array kChannels{'R', 'G', 'B'};

// Means over the blocks of an image, row by row.
struct Blocks {
  int across = 0, down = 0;
  std::vector<double> mean;
};

Blocks blocksOf(const std::vector<double>& values, int width, int height, int side) {
  Blocks b{(width + side - 1) / side, (height + side - 1) / side, {}};
  b.mean.assign(static_cast<size_t>(b.across) * static_cast<size_t>(b.down), 0.0);
  std::vector<double> count(b.mean.size(), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto to = static_cast<size_t>(y / side * b.across + x / side);
      b.mean[to] += values[static_cast<size_t>(y * width + x)];
      count[to] += 1.0;
    }
  }
  for (size_t i = 0; i < b.mean.size(); ++i) b.mean[i] /= count[i];
  return b;
}

// Sums over the seeds for each block.
struct Sums {
  std::vector<double> a, b, difference, squares;
  void add(const Blocks& blocksA, const Blocks& blocksB) {
    const size_t n = blocksA.mean.size();
    for (std::vector<double>* v : {&a, &b, &difference, &squares}) v->resize(n, 0.0);
    for (size_t i = 0; i < n; ++i) {
      const double d = blocksA.mean[i] - blocksB.mean[i];
      a[i] += blocksA.mean[i], b[i] += blocksB.mean[i];
      difference[i] += d, squares[i] += d * d;
    }
  }
  double t(size_t i, double seeds) const {
    const double mean = difference[i] / seeds;
    const double variance = std::max(0.0, squares[i] / seeds - mean * mean) * seeds / (seeds - 1.0);
    // Pixels are floats: equal values may round differently.
    const double rounding = 0x1p-20 * (std::fabs(a[i]) + std::fabs(b[i])) / seeds;
    const double error = std::sqrt(variance / seeds + rounding * rounding);
    return error > 0.0 ? mean / error : 0.0;
  }
};

std::vector<double> valuesOf(const Image& image, const std::string& channel, size_t& nonFinite) {
  const std::vector<float>& data = *image.find(channel);
  for (const float v : data) nonFinite += !std::isfinite(v);
  return {data.begin(), data.end()};
}

void keepPixels(const Sums& sums, char channel, double seeds, ZResult& result) {
  std::vector<float>& a = result.image.add(std::string("a.") + channel);
  for (size_t i = 0; i < a.size(); ++i) a[i] = static_cast<float>(sums.a[i] / seeds);
  std::vector<float>& b = result.image.add(std::string("b.") + channel);
  for (size_t i = 0; i < b.size(); ++i) b[i] = static_cast<float>(sums.b[i] / seeds);
  std::vector<float>& t = result.image.add(std::string("t.") + channel);
  for (size_t i = 0; i < t.size(); ++i) t[i] = static_cast<float>(sums.t(i, seeds));
}

std::string keptImage(const Image& image) {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(name.begin(), name.end(), '/', '-');
  const fs::path file = fs::temp_directory_path() / ("bnvpl-z-test-" + name + ".exr");
  writeExr(file, image, ExrPixelType::Float);
  return file.string();
}

}  // namespace

Render remembered(Render render) {
  return [render = std::move(render),
          kept = std::make_shared<std::map<uint64_t, Image>>()](uint64_t seed) {
    const auto [image, isNew] = kept->try_emplace(seed);
    if (isNew) image->second = render(seed);
    return image->second;
  };
}

ZResult zTest(const Render& a, const Render& b, const ZTest& options) {
  ZResult result;
  const double seeds = options.seeds;
  std::vector<std::array<Sums, 3>> levels;  // by the side of their blocks: 1, 2, 4, ...
  int width = 0, height = 0;
  for (uint64_t seed = 1; seed <= options.seeds; ++seed) {
    const Image imageA = a(seed), imageB = b(seed);
    width = imageA.width, height = imageA.height;
    while (levels.empty() || 1 << (levels.size() - 1) < std::max(width, height)) {
      levels.emplace_back();
    }
    for (size_t c = 0; c < kChannels.size(); ++c) {
      const std::string channel = options.layer + kChannels[c];
      const std::vector<double> valuesA = valuesOf(imageA, channel, result.nonFinite),
                                valuesB = valuesOf(imageB, channel, result.nonFinite);
      for (size_t l = 0; l < levels.size(); ++l) {
        levels[l][c].add(blocksOf(valuesA, width, height, 1 << l),
                         blocksOf(valuesB, width, height, 1 << l));
      }
    }
  }
  result.image.width = width, result.image.height = height;
  double worst = -1.0;
  for (size_t l = 0; l < levels.size(); ++l) {
    const int side = 1 << l, across = (width + side - 1) / side;
    for (size_t c = 0; c < kChannels.size(); ++c) {
      const Sums& sums = levels[l][c];
      if (l == 0) keepPixels(sums, kChannels[c], seeds, result);
      result.tests += sums.a.size();
      for (size_t i = 0; i < sums.a.size(); ++i) {
        if (sums.a[i] != 0.0 || sums.b[i] != 0.0) result.black = false;
      }
      for (size_t i = 0; i < sums.a.size(); ++i) {
        const double t = sums.t(i, seeds);
        if (!(std::fabs(t) > worst)) continue;
        worst = std::fabs(t);
        result.t = t;
        result.block = side;
        result.x = static_cast<int>(i) % across * side,
        result.y = static_cast<int>(i) / across * side;
        result.channel = kChannels[c];
        result.meanA = sums.a[i] / seeds, result.meanB = sums.b[i] / seeds;
      }
    }
  }
  result.p = sidak(studentTwoSided(result.t, seeds - 1.0), double(result.tests));
  return result;
}

testing::AssertionResult sameExpectation(const Render& a, const Render& b, const ZTest& options) {
  const ZResult r = zTest(a, b, options);
  if (r.nonFinite > 0) return testing::AssertionFailure() << r.nonFinite << " values not finite";
  if (r.black) return testing::AssertionFailure() << "all images are black";
  if (r.p >= options.significance) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "p = " << r.p << " over " << r.tests << " tests; the worst: " << r.channel << " of the "
         << r.block << " x " << r.block << " pixels from (" << r.x << ", " << r.y << "), "
         << r.meanA << " against " << r.meanB << ", t = " << r.t << " over " << options.seeds
         << " seeds; images: " << keptImage(r.image);
}

double noiseOf(const Render& render, uint64_t pairs, double limit) {
  std::vector<double> differences;
  for (uint64_t seed = 1; seed < 2 * pairs; seed += 2) {
    const Image a = render(seed), b = render(seed + 1);
    for (const char channel : kChannels) {
      const std::vector<float>&p = *a.find({channel}), &q = *b.find({channel});
      for (size_t i = 0; i < p.size(); ++i)
        differences.push_back(std::fabs(double{p[i]} - double{q[i]}));
    }
  }
  const auto last = differences.begin() + std::ptrdiff_t(limit * double(differences.size() - 1));
  std::ranges::nth_element(differences, last);
  const double largest = *last;
  double sum = 0.0;
  for (const double d : differences) sum += std::pow(std::min(d, largest), 2);
  return std::sqrt(sum / double(pairs));
}

}  // namespace bnvpl::test
