// Integrals of what a lamp with an emission texture or an alpha mask sends out, over parts of its
// triangles. The parts are cut along the lines between which a lookup is bilinear, and a quadrature
// that is exact for bilinear functions sums up the pieces: no texel is missed, however small it is.
// Where a lamp shows more texels than kMaxCells, the integrand is the texture box-filtered to that
// many: its mean stays the same, and what was not black stays so.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

class LampTexture {
 public:
  static constexpr double kMaxCells = 0x1p19;

  // Of a material of the scene, and the triangles that show it. Borrows the scene.
  LampTexture(const Scene& scene, uint32_t material, std::span<const uint32_t> triangles);

  // The side of a grid (emission_grid.h) whose cells are about a texel.
  uint32_t side(uint32_t triangle) const;

  struct Mean {
    std::array<double, 3> emission{};  // W/(m2 sr); 0 where the mask cuts the lamp away
    double weight = 0.0;               // for drawing points: not 0 unless all of it is black
  };
  // Over a part of a triangle, by barycentric coordinates of its corners.
  Mean over(uint32_t triangle, const std::array<std::array<double, 2>, 3>& part) const;

 private:
  // Lines across texture coordinates: x = a u + b v + c, y = d u + e v + f at whole numbers, of
  // which those from -1 to columns or rows count where the texture does not repeat.
  struct Lines {
    double a = 0, b = 0, c = 0, d = 0, e = 0, f = 0;
    std::array<double, 2> last{};  // columns, rows
    std::array<bool, 2> repeats{}, none{};
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
  std::optional<std::array<std::array<double, 2>, 3>> uvsOf(uint32_t triangle) const;
  template <typename Fn>
  void forBands(const Polygon& polygon, size_t axis, const Fn& fn) const;
  void add(uint32_t triangle, const std::array<Corner, 3>& piece, int halvings, Mean& sum) const;
  void addPoint(uint32_t triangle, double b1, double b2, double area, Mean& sum) const;

  const Scene& scene_;
  const Material& material_;
  std::vector<Texture> coarse_;  // in place of the scene's; empty: those are used
  Lines lines_;
  bool exact_ = true;  // one texture says all that shines
};

}  // namespace bnvpl
