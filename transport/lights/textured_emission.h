// Integrals of the emission of a lamp with an emission texture or an alpha mask over parts of its
// triangles. The parts are clipped along the lines between which a lookup is bilinear, and
// integrated by a quadrature that is exact for bilinear functions, so that no texel is missed.
// Where a lamp shows more texels than kMaxCells, the texture is first box-filtered to that many,
// which keeps its mean and leaves no emissive texel black.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

class TexturedEmission {
 public:
  static constexpr double kMaxCells = 0x1p19;
  static constexpr double kMaxSquares = 2 * kMaxCells;  // number of squares of checkerboards

  // Takes an emissive material of the scene, and the triangles that have it. Borrows the scene.
  TexturedEmission(const Scene& scene, uint32_t material, std::span<const uint32_t> triangles);

  // The side of a grid (emission_grid.h) whose cells are about a texel.
  uint32_t side(uint32_t triangle) const;

  struct Mean {
    std::array<double, 3> emission{};  // W/(m2 sr); 0 where the mask cuts the lamp away
    double weight = 0.0;               // for importance sampling; 0 only if the whole part is black
  };
  // The mean over a part of a triangle, given the barycentric coordinates of its corners.
  Mean over(uint32_t triangle, const std::array<std::array<double, 2>, 3>& part) const;

 private:
  // Lines where x = a u + b v + c or y = d u + e v + f is an integer. Where the texture does not
  // repeat, only the lines from -1 to the number of columns or rows count.
  struct Lines {
    double a = 0, b = 0, c = 0, d = 0, e = 0, f = 0;
    std::array<double, 2> last{};  // number of columns and rows
    std::array<bool, 2> repeats{}, none{};
    bool clamped = false;  // whether the texture may be 0 between texels that are not
    double perUv() const;
  };
  struct Corner {
    double b1, b2, x, y;
  };
  struct Polygon;
  struct Cells {
    double area = 0, length = 0;
  };

  Lines linesOf(const TextureExpression& e) const;
  void addLines(uint32_t expression, std::vector<Lines>& out) const;
  void chooseLines();
  void coarsen(double factor);
  Cells cellsOf(uint32_t triangle) const;
  Cells sumOfCells(std::span<const uint32_t> triangles) const;
  std::optional<std::array<std::array<double, 2>, 3>> uvsOf(uint32_t triangle) const;
  template <typename Fn>
  void forBands(const Polygon& polygon, size_t axis, const Fn& fn) const;
  void add(uint32_t triangle, const std::array<Corner, 3>& piece, int halvings, Mean& sum) const;
  void addPoint(uint32_t triangle, double b1, double b2, double area, Mean& sum) const;

  const Scene& scene_;
  const Material& material_;
  std::vector<Texture> coarse_;  // replace the scene's textures, unless empty
  Lines lines_;
  bool exact_ = true;  // whether one texture, that of lines_, determines the emission
};

}  // namespace bnvpl
