#include "scene/read/pbrt/pixel_filter.h"

#include <algorithm>
#include <cmath>

namespace bnvpl::pbrt {

namespace {

constexpr double kSame = 1e-3;  // relative difference of lengths that nobody sees

// Standard deviation of pbrt's Gaussian along an axis: lowered to reach 0 at the radius.
double gaussianDeviation(double sigma, double radius) {
  constexpr int kSteps = 1000;
  const auto bell = [&](double x) { return std::exp(-0.5 * x * x / (sigma * sigma)); };
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps * radius, value = bell(x) - bell(radius);
    sum += value;
    squares += value * x * x;
  }
  // A bell that is flat up to the radius is a parabola, as far as numbers tell.
  return sum > 0.0 ? std::sqrt(squares / sum) : radius / std::sqrt(5.0);
}

// The radius of our Gaussian, whose sigma is a third of it, with this standard deviation.
double gaussianRadius(double deviation) {
  static const double ofRadiusOne = gaussianDeviation(1.0 / 3.0, 1.0);
  return deviation / ofRadiusOne;
}

// Reads a PixelFilter, and notes what becomes of it.
class Reader {
 public:
  Reader(const Entity& entity, Notes& notes) : entity_(entity), notes_(notes) {}

  FilterSpec box() const { return made(FilterKind::Box, radius(0.5)); }

  FilterSpec gaussian() const {
    const double given = radius(1.5), sigma = entity_.params.number("sigma", 0.5, 1e-3, 1e3);
    if (std::fabs(3.0 * sigma - given) <= kSame * given) return made(FilterKind::Gaussian, given);
    note("a gaussian whose sigma is not a third of its radius becomes one of the same spread");
    return made(FilterKind::Gaussian, gaussianRadius(gaussianDeviation(sigma, given)));
  }

  FilterSpec mitchell() const {
    const auto isThird = [&](const char* name) {
      return std::fabs(entity_.params.number(name, 1.0 / 3.0) - 1.0 / 3.0) <= kSame;
    };
    const bool thirds = isThird("B"), both = isThird("C") && thirds;
    if (!both) note("a mitchell filter has B and C of 1/3");
    return made(FilterKind::Mitchell, radius(2.0));
  }

  FilterSpec triangle() const {
    note("a triangle becomes a gaussian of the same spread");
    return made(FilterKind::Gaussian, gaussianRadius(radius(2.0) / std::sqrt(6.0)));
  }

  // A sinc of any radius crosses 0 one pixel from its centre; so does, nearly, a mitchell filter of
  // radius 2.
  FilterSpec sinc() const {
    entity_.params.ignore({"xradius", "yradius", "tau"});
    note("a windowed sinc becomes a mitchell filter of radius 2");
    return made(FilterKind::Mitchell, 2.0);
  }

 private:
  void note(const std::string& text) const {
    notes_.add(entity_.place, "PixelFilter \"" + entity_.type + "\": " + text);
  }
  double radius(double usual) const {
    const double x = entity_.params.number("xradius", usual, 1e-3, 1e3),
                 y = entity_.params.number("yradius", usual, 1e-3, 1e3);
    if (std::fabs(x - y) <= kSame * x) return x;
    note("the filter is as wide as high; its area is kept");
    return std::sqrt(x * y);
  }
  FilterSpec made(FilterKind kind, double radius) const {
    const double within = std::clamp(radius, kMinFilterRadius, kMaxFilterRadius);
    if (within != radius) note("the radius is brought to between 0.25 and 8 pixels");
    return {kind, static_cast<float>(within)};
  }

  const Entity& entity_;
  Notes& notes_;
};

}  // namespace

FilterSpec filterOf(const Description& description, Notes& notes) {
  const Entity& entity = description.pixelFilter;
  const Reader reader(entity, notes);
  if (entity.type == "box") return reader.box();
  if (entity.type == "gaussian") return reader.gaussian();
  if (entity.type == "mitchell") return reader.mitchell();
  if (entity.type == "triangle") return reader.triangle();
  if (entity.type == "sinc") return reader.sinc();
  if (!entity.type.empty()) {
    notes.add(entity.place, "PixelFilter '" + entity.type + "' is not read; it becomes the box");
  }
  return {};
}

}  // namespace bnvpl::pbrt
