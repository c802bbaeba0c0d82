// The light of each light group (Scene::lightGroups) at every pixel, beside PixelSums.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "formats/image/image.h"
#include "scene/scene.h"
#include "tools/render/sample.h"
#include "tools/render/splat/splat.h"

namespace bnvpl {

struct FilmGroups {
  uint32_t count = 0;        // groups; 0: not told apart
  std::vector<double> sums;  // R, G, B of each group of each pixel: the light that the image shows
  // For each pixel, as in PixelSums: the two brightest samples of direct and of indirect light,
  // each followed by its parts by group.
  std::vector<Vec3> brightest;
  std::vector<uint8_t> photons;  // groups of the two brightest photons of each pixel

  FilmGroups() = default;
  FilmGroups(size_t pixels, uint32_t groups)
      : count(groups),
        sums(groups > 0 ? pixels * sumsPerPixel() : 0),
        brightest(groups > 0 ? pixels * brightestPerPixel() : 0),
        photons(groups > 0 ? 2 * pixels : 0) {}

  size_t sumsPerPixel() const { return size_t{3} * count; }
  size_t brightestPerPixel() const { return size_t{4} * (1 + count); }

  // Adds a sample times `share`, which must be finite.
  void add(size_t pixel, const CameraSample& sample, ShownLight shown, float share);
  void add(const Splat& splat, float share);
  // Part by group of a pixel's sample: `kind` 0 direct, 1 indirect; `rank` 0 or 1.
  const Vec3* brightestOf(size_t pixel, size_t kind, size_t rank) const {
    return &brightest[pixel * brightestPerPixel() + (2 * kind + rank) * (1 + count) + 1];
  }
  // Calls fn(name of the work, array, values of each pixel) for every array.
  template <typename Fn>
  void forArrays(const Fn& fn) {
    if (count == 0) return;
    fn("groups", sums, sumsPerPixel());
    fn("group.bright", brightest, brightestPerPixel());
    fn("group.photons", photons, 2);
  }

 private:
  void keepBrightest(size_t pixel, size_t kind, Vec3 light, const Vec3* groups, float share);
};

// Adds R, G, B of each group to the image, which has its own R, G, B. `perSample`: factor of the
// sums. `redistributed`: change of each group of each pixel by redistributeFireflies(), or empty.
// What rounding leaves between the groups and the image goes to the largest group.
void addGroups(const FilmGroups& groups, const std::vector<std::string>& names, double perSample,
               const std::vector<Vec3>& redistributed, Image& image);

}  // namespace bnvpl
