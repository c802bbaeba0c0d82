// A smoothing filter over the film that stops at the edges of surfaces: an a-trous wavelet
// transform (Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination
// Filtering, HPG 2010), by separable steps.
//
// Level l is a step with five taps, 2^l pixels apart, along x and then along y:
//
//   (S_l f)_i = sum over taps k of  b_k w(i, i + k 2^l) f_(i + k 2^l),   b = (1, 4, 6, 4, 1) / 16
//
// with 0 <= w <= 1: 1 where two pixels see one surface, 0 across an edge of normal, depth or
// albedo. w is symmetric. The composite S_l ... S_0 on a plane is a cubic B-spline whose support is
// 2^(l+3) pixels wide; a step jumps over thin objects in front of the surface. Weights are not
// normalised: the caller must make up for the weight that a step loses at edges.
#pragma once

#include <span>
#include <vector>

#include "tools/render/film/layers.h"

namespace bnvpl {

// One value for each pixel, row by row.
using FilmValues = std::vector<float>;

class SurfaceFilter {
 public:
  // Whether the filter stops at edges of surfaces. It always stops at the background.
  enum class Edges { Stop, Ignore };
  // The surface of each pixel is the mean of its samples.
  SurfaceFilter(std::span<const PixelSums> sums, size_t width, Edges edges);

  size_t pixels() const { return surfaces_.size(); }
  // Number of levels until the filter is as wide as the film.
  size_t levels() const;

  // S_level of `values`, and its adjoint: the same steps in reverse order.
  FilmValues smooth(const FilmValues& values, size_t level) const;
  FilmValues scatter(const FilmValues& values, size_t level) const;

  // Peak of the kernel of S_level ... S_0 on a plane.
  static double peak(size_t level);

  // Weight of a pixel's own value in S_0.
  static constexpr float kCentre = 36 / 256.0f;

 private:
  struct Surface {
    Vec3 normal, albedo;
    float inverseDepth = 0.0f;  // 0: the pixel shows no surface and takes no part in the filter
    float slope[2] = {};        // change of inverseDepth per pixel along x and y
  };
  enum Axis : size_t { kX, kY };
  void findSlopes();
  float weight(size_t i, size_t j, Axis axis, float pixelsApart) const;
  FilmValues along(const FilmValues& values, Axis axis, size_t level) const;

  size_t width_, height_;
  Edges edges_;
  std::vector<Surface> surfaces_;
};

}  // namespace bnvpl
