#include "scene/read/pbrt/colors/colors.h"

#include <algorithm>

#include "core/files.h"
#include "core/number_text.h"

namespace bnvpl::pbrt {

namespace {

constexpr double kHottest = 1e6, kColdest = 100.0;  // kelvin

double temperatureOf(const Param& p) {
  if (p.numbers.empty() || p.numbers.size() > 2)
    failAt(p.place, "'" + p.name + "' must be a temperature in kelvin");
  if (!(p.numbers[0] >= kColdest && p.numbers[0] <= kHottest))
    failAt(p.place, "'" + p.name + "' must be 100 to 1000000 kelvin");
  return p.numbers[0];
}

// The scale factor that pbrt-v3 allows behind the temperature.
float scaleOf(const Param& p) {
  if (p.numbers.size() < 2) return 1.0f;
  if (!(p.numbers[1] >= 0.0)) failAt(p.place, "'" + p.name + "' must have a scale of 0 or more");
  return static_cast<float>(p.numbers[1]);
}

Vec3 clamped(Vec3 v, float most) { return min(max(v, Vec3{}), Vec3{most}); }

}  // namespace

Vec3 rgbOf(const Param& p) {
  if (p.numbers.size() != 3) failAt(p.place, "'" + p.name + "' must be three numbers");
  return {float(p.numbers[0]), float(p.numbers[1]), float(p.numbers[2])};
}

void noteClamped(const Param& p, double most, Notes& notes) {
  const auto beyond =
      std::ranges::find_if(p.numbers, [&](double n) { return n < 0.0 || n > most; });
  if (beyond == p.numbers.end()) return;
  notes.add(p.place, "'" + p.name + "' has " + shortestText(*beyond) + ", which counts as " +
                         (*beyond < 0.0 ? "0" : shortestText(most)));
}

// Reads a spectrum from a name, a file, or pairs of numbers.
Spectrum Colors::spectrum(const Param& p) const {
  if (p.strings.empty()) {
    const auto s = spectrumOf(p.numbers);
    if (!s)
      failAt(p.place,
             "'" + p.name + "' must be pairs of rising wavelength (nm) and value, not negative");
    if (s->nm.size() == 1)
      notes_.add(p.place, "'" + p.name + "' has one sample, and is 0 at all other wavelengths");
    return *s;
  }
  if (p.strings.size() != 1) failAt(p.place, "'" + p.name + "' must be one spectrum");
  if (const auto known = namedSpectrum(p.strings[0])) return *known;
  const fs::path file = (folder_ / p.strings[0]).lexically_normal();
  if (!isRegularFile(file)) {
    failAt(p.place, "'" + p.name + "': there is no spectrum or file '" + p.strings[0] + "'");
  }
  files_.push_back(file);
  return readSpd(file);
}

Vec3 Colors::checked(const Param& p, double most) const {
  noteClamped(p, most, notes_);
  return p.type == ParamType::Float ? Vec3{float(p.numbers[0])} : rgbOf(p);
}

Vec3 Colors::light(const Params& params, const std::string& name, ColorSpace space) const {
  const Param* p = params.find(
      name, {ParamType::Rgb, ParamType::Blackbody, ParamType::Spectrum, ParamType::Float},
      "an rgb, blackbody or spectrum");
  if (!p) return intoGamut(srgbOfLight(Vec3{1.0f}, space));
  if (p->type == ParamType::Rgb)
    return intoGamut(srgbOfLight(max(checked(*p), Vec3{}), p->colorSpace));
  if (p->type == ParamType::Blackbody)
    return intoGamut(srgbOf(xyzOfLight(blackbody(temperatureOf(*p))))) * scaleOf(*p);
  if (p->type == ParamType::Float) {
    failAt(p->place, "'" + name + "' must be an rgb, blackbody or spectrum");
  }
  if (!p->strings.empty()) {
    if (const auto named = namedIlluminant(p->strings[0])) return intoGamut(srgbOf(*named));
  }
  return intoGamut(srgbOf(xyzOfLight(spectrum(*p))));
}

Vec3 Colors::reflectance(const Param& p) const {
  if (p.type == ParamType::Rgb)
    return clamped(srgbOfReflectance(checked(p, 1.0), p.colorSpace), 1.0f);
  if (p.type == ParamType::Float && p.numbers.size() == 1) return clamped(checked(p, 1.0), 1.0f);
  if (p.type == ParamType::Spectrum) return clamped(srgbOf(xyzUnderD65(spectrum(p))), 1.0f);
  failAt(p.place, "'" + p.name + "' must be an rgb or spectrum");
}

Vec3 Colors::unbounded(const Param& p) const {
  constexpr float kMaxFloat = 1e30f;
  if (p.type == ParamType::Rgb)
    return clamped(srgbOfReflectance(checked(p), p.colorSpace), kMaxFloat);
  if (p.type == ParamType::Float && p.numbers.size() == 1) return clamped(checked(p), kMaxFloat);
  if (p.type == ParamType::Spectrum) return clamped(srgbOf(xyzUnderD65(spectrum(p))), kMaxFloat);
  failAt(p.place, "'" + p.name + "' must be an rgb or spectrum");
}

double Colors::ior(const Params& params, const std::string& name, double otherwise) const {
  const Param* p =
      params.find(name, {ParamType::Float, ParamType::Integer, ParamType::Spectrum, ParamType::Rgb},
                  "a float or spectrum");
  if (!p) return otherwise;
  double eta;
  if (p->type == ParamType::Spectrum && p->strings.empty() && p->numbers.size() == 2) {
    eta = p->numbers[1];
  } else if (p->type == ParamType::Spectrum) {
    constexpr double kYellow = 587.6;  // nm, Fraunhofer line d
    Spectrum s = spectrum(*p);
    s.constantBeyond = true;  // an index of 0 would be no glass
    eta = s.at(kYellow);
    notes_.add(p->place,
               "'" + name + "' varies with wavelength: that at 587.6 nm is taken for all");
  } else {
    eta = p->type == ParamType::Rgb ? double{mean(rgbOf(*p))} : params.number(name, otherwise);
  }
  // An index of 0 means no interface, as in pbrt.
  if (eta == 0.0) return 1.0;
  constexpr double kMin = 0.01, kMaxIor = 100.0;
  if (!(eta >= kMin && eta <= kMaxIor))
    failAt(p->place, "'" + name + "' must be a refractive index from 0.01 to 100");
  return eta;
}

double Colors::coatIor(const Params& params, const std::string& name, double otherwise) const {
  const double eta = ior(params, name, otherwise);
  if (eta < 1.0) notes_.add(*params.placeOf(name), "'" + name + "' of a coat below 1 counts as 1");
  return std::max(1.0, eta);
}

MetalRgb Colors::metal(const Params& params, const std::string& etaName,
                       const std::string& kName) const {
  const Param *eta = params.find(etaName), *k = params.find(kName);
  const bool etaSpectral = !eta || isSpectrum(eta), kSpectral = !k || isSpectrum(k);
  if (etaSpectral && kSpectral) {
    return metalRgb(eta ? spectrum(*eta) : *namedSpectrum("metal-Cu-eta"),
                    k ? spectrum(*k) : *namedSpectrum("metal-Cu-k"));
  }
  const MetalRgb copper = metalRgb(*namedSpectrum("metal-Cu-eta"), *namedSpectrum("metal-Cu-k"));
  return {eta ? unbounded(*eta) : copper.eta, k ? unbounded(*k) : copper.k};
}

}  // namespace bnvpl::pbrt
