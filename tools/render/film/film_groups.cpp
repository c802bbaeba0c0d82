#include "tools/render/film/film_groups.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace bnvpl {

void FilmGroups::add(size_t pixel, const CameraSample& sample, ShownLight shown, float share) {
  if (count == 0) return;
  const Vec3 *emission = sample.groups.emission().sums, *direct = sample.groups.direct().sums,
             *indirect = sample.groups.indirect().sums;
  const RadianceSample& r = sample.radiance;
  double* sum = &sums[pixel * sumsPerPixel()];
  for (uint32_t g = 0; g < count; ++g) {
    Vec3 light;
    if (shown != ShownLight::Indirect) light += emission[g] + direct[g];
    if (shown != ShownLight::Direct)
      light += r.photons.groups ? indirect[g] + r.photons.groups[g] : indirect[g];
    for (size_t c = 0; c < 3; ++c) sum[3 * g + c] += double{light[c]} * double{share};
  }
  keepBrightest(pixel, 0, r.direct - r.emission, direct, share);
  keepBrightest(pixel, 1, r.indirect - r.photons.all - r.toFilter, indirect, share);
  for (size_t k = 0; k < 2; ++k) photons[2 * pixel + k] = r.photons.brightestGroup[k];
}

void FilmGroups::keepBrightest(size_t pixel, size_t kind, Vec3 light, const Vec3* groups,
                               float share) {
  const size_t row = 1 + count;
  Vec3* first = &brightest[pixel * brightestPerPixel() + 2 * kind * row];
  Vec3* second = first + row;
  const float own = magnitude(light * share), largest = magnitude(*first);
  if (!(own > magnitude(*second))) return;
  if (own > largest) std::copy_n(first, row, second);
  Vec3* to = own > largest ? first : second;
  *to++ = light * share;
  for (uint32_t g = 0; g < count; ++g) *to++ = groups[g] * share;
}

void FilmGroups::add(const Splat& splat, float share) {
  if (count == 0) return;
  double* sum = &sums[splat.pixel * sumsPerPixel() + size_t{3} * splat.group];
  for (size_t c = 0; c < 3; ++c) sum[c] += double{splat.radiance[c] * share};
}

void addGroups(const FilmGroups& groups, const std::vector<std::string>& names, double perSample,
               const std::vector<Vec3>& redistributed, Image& image) {
  const size_t count = groups.count;
  const size_t first = image.channels.size();
  for (size_t k = 0; k < 3 * count; ++k) image.add("light_" + names[k / 3] + "." + "RGB"[k % 3]);
  for (size_t c = 0; c < 3 && count > 0; ++c) {
    const std::vector<float>& shown = *image.find(std::string(1, "RGB"[c]));
    parallelFor(shown.size(), 1024, [&](size_t i) {
      std::array<double, kMaxLightGroups> light{};
      double rest{shown[i]};
      size_t largest = 0;
      for (size_t g = 0; g < count; ++g) {
        light[g] = groups.sums[i * groups.sumsPerPixel() + 3 * g + c] * perSample;
        if (!redistributed.empty()) light[g] += double{redistributed[i * count + g][c]};
        rest -= light[g];
        if (std::fabs(light[g]) > std::fabs(light[largest])) largest = g;
      }
      light[largest] += rest;
      for (size_t g = 0; g < count; ++g)
        image.channels[first + 3 * g + c].data[i] = static_cast<float>(light[g]);
    });
  }
}

}  // namespace bnvpl
