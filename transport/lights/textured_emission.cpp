#include "transport/lights/textured_emission.h"

#include <algorithm>
#include <cmath>

#include "transport/accelerator/alpha_mask.h"

namespace bnvpl {

namespace {

// A mask is discontinuous between the centres of texels, so the sides of its pieces are halved.
constexpr int kHalvingsOfMask = 2;
// Share of the constant emission that is added to weights where the quadrature is not exact.
constexpr double kFloor = 0.02;
// Max texel coordinate that is clipped; beyond, floats cannot tell texels apart.
constexpr double kMaxTexel = 0x1p31;

Texture boxFiltered(const Texture& from, uint32_t width, uint32_t height) {
  Texture to;
  to.width = width;
  to.height = height;
  to.srgb = false;
  to.scale = from.scale;
  to.offset = from.offset;
  to.floats.resize(size_t{4} * width * height);
  const auto sharesOf = [](uint32_t i, uint32_t coarse, uint32_t fine, const auto& fn) {
    const double begin = double(i) * fine / coarse, end = double(i + 1) * fine / coarse;
    for (auto k = static_cast<uint32_t>(begin); k < fine && k < end; ++k)
      fn(k, (std::min(end, k + 1.0) - std::max(begin, double(k))) / (end - begin));
  };
  for (uint32_t j = 0; j < height; ++j) {
    for (uint32_t i = 0; i < width; ++i) {
      std::array<double, 4> sum{};
      sharesOf(j, height, from.height, [&](uint32_t y, double down) {
        sharesOf(i, width, from.width, [&](uint32_t x, double across) {
          const Vec3 c = from.texel(x, y);
          for (size_t k = 0; k < 3; ++k) sum[k] += double{c[k]} * across * down;
          sum[3] += double{from.texelAlpha(x, y)} * across * down;
        });
      });
      for (size_t k = 0; k < 4; ++k)
        to.floats[4 * (size_t{j} * width + i) + k] = static_cast<float>(sum[k]);
    }
  }
  return to;
}

void addImages(const Scene& scene, uint32_t expression, std::vector<uint32_t>& out) {
  if (expression == kNone) return;
  const TextureExpression& e = scene.expressions[expression];
  if (e.image != kNone) out.push_back(e.image);
  for (const uint32_t operand : {e.first, e.second, e.amount}) addImages(scene, operand, out);
}

}  // namespace

struct TexturedEmission::Polygon {
  std::array<Corner, 16> corners;
  size_t count = 0;
  void add(const Corner& c) {
    if (count < corners.size()) corners[count++] = c;
  }
  static double along(const Corner& c, size_t axis) { return axis == 0 ? c.x : c.y; }
  // The part on one side of a line.
  Polygon clipped(size_t axis, double line, bool above) const {
    Polygon out;
    for (size_t i = 0; i < count; ++i) {
      const Corner &p = corners[i], &q = corners[(i + 1) % count];
      const double dp = along(p, axis) - line, dq = along(q, axis) - line;
      const auto inside = [&](double d) { return above ? d >= 0.0 : d <= 0.0; };
      if (inside(dp)) out.add(p);
      if (inside(dp) == inside(dq) || dp == 0.0 || dq == 0.0) continue;
      const double t = dp / (dp - dq);
      const auto mix = [t](double a, double b) { return a + t * (b - a); };
      out.add({mix(p.b1, q.b1), mix(p.b2, q.b2), mix(p.x, q.x), mix(p.y, q.y)});
    }
    return out;
  }
};

double TexturedEmission::Lines::perUv() const { return std::fabs(a * e - b * d); }

TexturedEmission::TexturedEmission(const Scene& scene, uint32_t material,
                                   std::span<const uint32_t> triangles)
    : scene_(scene), material_(scene.materials[material]) {
  chooseLines();
  const Cells all = sumOfCells(triangles);
  double factor = 1.0;
  while (all.area / (factor * factor) + all.length / factor > kMaxCells && factor < 0x1p16)
    factor *= 1.25;
  if (factor == 1.0) return;
  coarsen(factor);
  chooseLines();
  // Checkerboards cannot be coarsened. Where their squares are too many, the quadrature has fewer
  // lines than they.
  const Cells left = sumOfCells(triangles);
  const double fewer = std::max(std::sqrt(left.area / kMaxSquares), left.length / kMaxSquares);
  if (!(fewer > 1.0)) return;
  for (double* along : {&lines_.a, &lines_.b, &lines_.c, &lines_.d, &lines_.e, &lines_.f})
    *along /= fewer;
  exact_ = false;
}

void TexturedEmission::coarsen(double factor) {
  std::vector<uint32_t> images;
  addImages(scene_, material_.emissionTexture, images);
  coarse_.resize(scene_.textures.size());
  const auto side = [factor](uint32_t n) {
    return std::max(1u, static_cast<uint32_t>(std::ceil(n / factor)));
  };
  for (const uint32_t i : images) {
    const Texture& t = scene_.textures[i];
    if (coarse_[i].width == 0) coarse_[i] = boxFiltered(t, side(t.width), side(t.height));
  }
}

TexturedEmission::Lines TexturedEmission::linesOf(const TextureExpression& e) const {
  const UvTransform& m = e.uv;
  Lines l{m.a, m.b, m.c, m.d, m.e, m.f};
  if (e.kind == TextureExpression::Kind::Checkerboard) {
    l.repeats = {true, true};
    return l;
  }
  const Texture& t =
      coarse_.empty() || coarse_[e.image].width == 0 ? scene_.textures[e.image] : coarse_[e.image];
  const double w = t.width, h = t.height, sx = t.scale[0] * w, sy = -t.scale[1] * h;
  l = {sx * m.a, sx * m.b, sx * m.c + t.offset[0] * w - 0.5,
       sy * m.d, sy * m.e, sy * m.f + (1.0 - t.offset[1]) * h - 0.5};
  l.last = {w, h};
  const auto repeats = [](Wrap wrap) { return wrap == Wrap::Repeat || wrap == Wrap::Mirror; };
  l.repeats = {repeats(e.wrapU), repeats(e.wrapV)};
  l.none = {l.repeats[0] && t.width == 1, l.repeats[1] && t.height == 1};
  return l;
}

void TexturedEmission::addLines(uint32_t expression, std::vector<Lines>& out) const {
  if (expression == kNone) return;
  const TextureExpression& e = scene_.expressions[expression];
  using Kind = TextureExpression::Kind;
  const bool image = e.kind == Kind::Image && e.image != kNone;
  if (image || e.kind == Kind::Checkerboard) out.push_back(linesOf(e));
  // 1 - value, which is clamped at 0 where the image is above 1.
  if (image && e.invert)
    out.back().clamped = maxComponent(e.value) > 1.0f || !scene_.textures[e.image].floats.empty();
  for (const uint32_t operand : {e.first, e.second, e.amount}) addLines(operand, out);
}

// Takes the lines of the finest texture; for others the quadrature is approximate.
void TexturedEmission::chooseLines() {
  std::vector<Lines> all;
  addLines(material_.emissionTexture, all);
  const size_t ofEmission = all.size();
  if (material_.masked()) {
    addLines(material_.opacityTexture, all);
    if (material_.opacityMap != kNone)
      all.push_back(linesOf(imageExpression(material_.opacityMap)));
  }
  const auto finest = std::ranges::max_element(all, {}, &Lines::perUv);
  lines_ = {};
  lines_.none = {true, true};
  if (finest != all.end()) lines_ = *finest;
  exact_ = ofEmission == 0 || (ofEmission == 1 && finest == all.begin() && !finest->clamped);
}

std::optional<std::array<std::array<double, 2>, 3>> TexturedEmission::uvsOf(
    uint32_t triangle) const {
  const Triangle& t = scene_.triangles[triangle];
  std::array<std::array<double, 2>, 3> out{};
  for (size_t k = 0; k < 3; ++k) {
    if (t.uv[k] == kNone) return std::nullopt;
    const auto& uv = scene_.uvs[t.uv[k]];
    if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) return std::nullopt;
    out[k] = {uv[0], uv[1]};
  }
  return out;
}

TexturedEmission::Cells TexturedEmission::cellsOf(uint32_t triangle) const {
  const auto uv = uvsOf(triangle);
  if (!uv) return {};
  std::array<double, 3> x{}, y{};
  for (size_t k = 0; k < 3; ++k) {
    x[k] = lines_.a * (*uv)[k][0] + lines_.b * (*uv)[k][1];
    y[k] = lines_.d * (*uv)[k][0] + lines_.e * (*uv)[k][1];
  }
  const auto extent = [&](const std::array<double, 3>& v, size_t axis) {
    const double e = *std::ranges::max_element(v) - *std::ranges::min_element(v);
    return lines_.none[axis] ? 0.0 : lines_.repeats[axis] ? e : std::min(e, lines_.last[axis] + 2);
  };
  const double ex = extent(x, 0), ey = extent(y, 1);
  const double area =
      0.5 * std::fabs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
  return {std::min(area, ex * ey), ex + ey};
}

TexturedEmission::Cells TexturedEmission::sumOfCells(std::span<const uint32_t> triangles) const {
  Cells sum;
  for (const uint32_t t : triangles) {
    const Cells cells = cellsOf(t);
    sum.area += cells.area;
    sum.length += cells.length;
  }
  return sum;
}

uint32_t TexturedEmission::side(uint32_t triangle) const {
  if (material_.emissionTexture == kNone) return 1;
  constexpr double kMax = 1024;
  const Cells cells = cellsOf(triangle);
  return static_cast<uint32_t>(std::clamp(std::ceil(std::sqrt(cells.area)), 1.0, kMax));
}

template <typename Fn>
void TexturedEmission::forBands(const Polygon& polygon, size_t axis, const Fn& fn) const {
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < polygon.count; ++i) {
    low = std::min(low, Polygon::along(polygon.corners[i], axis));
    high = std::max(high, Polygon::along(polygon.corners[i], axis));
  }
  Polygon rest = polygon;
  if (!lines_.none[axis] && low > -kMaxTexel && high < kMaxTexel) {
    double line = std::floor(low) + 1.0, end = high;
    if (!lines_.repeats[axis]) {
      line = std::max(line, -1.0);
      end = std::min(end, lines_.last[axis] + 0.5);
    }
    for (; line < end && rest.count >= 3; line += 1.0) {
      fn(rest.clipped(axis, line, false));
      rest = rest.clipped(axis, line, true);
    }
  }
  fn(rest);
}

TexturedEmission::Mean TexturedEmission::over(
    uint32_t triangle, const std::array<std::array<double, 2>, 3>& part) const {
  Polygon whole;
  const auto uv = uvsOf(triangle);
  for (const auto& [b1, b2] : part) {
    Corner c{b1, b2, 0, 0};
    if (uv) {
      const double b0 = 1.0 - b1 - b2;
      const double u = b0 * (*uv)[0][0] + b1 * (*uv)[1][0] + b2 * (*uv)[2][0],
                   v = b0 * (*uv)[0][1] + b1 * (*uv)[1][1] + b2 * (*uv)[2][1];
      c.x = lines_.a * u + lines_.b * v + lines_.c;
      c.y = lines_.d * u + lines_.e * v + lines_.f;
    }
    whole.add(c);
  }
  Mean sum;
  const int halvings = material_.masked() ? kHalvingsOfMask : 0;
  forBands(whole, 1, [&](const Polygon& band) {
    forBands(band, 0, [&](const Polygon& piece) {
      for (size_t i = 2; i < piece.count; ++i) {
        add(triangle, {piece.corners[0], piece.corners[i - 1], piece.corners[i]}, halvings, sum);
      }
    });
  });
  const auto &p = part[0], &q = part[1], &r = part[2];
  const double area = std::fabs((q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]));
  for (double& e : sum.emission) e /= area;
  sum.weight /= area;
  if (!exact_) sum.weight += kFloor * double{mean(material_.emission)};
  return sum;
}

// Quadrature with three interior points (Strang & Fix 1973), which is exact up to degree 2 and has
// no point on a line.
void TexturedEmission::add(uint32_t triangle, const std::array<Corner, 3>& piece, int halvings,
                           Mean& sum) const {
  const auto& [p, q, r] = piece;
  const auto between = [](const Corner& a, const Corner& b) {
    return Corner{0.5 * (a.b1 + b.b1), 0.5 * (a.b2 + b.b2), 0, 0};
  };
  if (halvings > 0) {
    const Corner pq = between(p, q), qr = between(q, r), rp = between(r, p);
    for (const std::array<Corner, 3>& quarter : {std::array{p, pq, rp}, std::array{pq, q, qr},
                                                 std::array{rp, qr, r}, std::array{pq, qr, rp}})
      add(triangle, quarter, halvings - 1, sum);
    return;
  }
  const double area = std::fabs((q.b1 - p.b1) * (r.b2 - p.b2) - (r.b1 - p.b1) * (q.b2 - p.b2));
  const double third1 = (p.b1 + q.b1 + r.b1) / 3.0, third2 = (p.b2 + q.b2 + r.b2) / 3.0;
  for (const Corner& c : piece) {
    addPoint(triangle, 0.5 * (c.b1 + third1), 0.5 * (c.b2 + third2), area / 3.0, sum);
  }
}

void TexturedEmission::addPoint(uint32_t triangle, double b1, double b2, double area,
                                Mean& sum) const {
  Vec3 emission = material_.emission;
  bool there = !(material_.opacity < material_.opacityCutoff);
  if (const auto uv = uvsOf(triangle)) {
    const double b0 = 1.0 - b1 - b2;
    const auto u = float(b0 * (*uv)[0][0] + b1 * (*uv)[1][0] + b2 * (*uv)[2][0]),
               v = float(b0 * (*uv)[0][1] + b1 * (*uv)[1][1] + b2 * (*uv)[2][1]);
    there = !material_.masked() || passesAlphaTest(scene_, material_, u, v);
    if (material_.emissionTexture != kNone) {
      const std::span<const Texture> textures = coarse_.empty() ? scene_.textures : coarse_;
      emission = emission *
                 TextureEvaluator(scene_.expressions, textures).at(material_.emissionTexture, u, v);
    }
  }
  sum.weight += area * double{mean(emission)};
  if (!there) return;
  for (size_t c = 0; c < 3; ++c) sum.emission[c] += area * double{emission[c]};
}

}  // namespace bnvpl
