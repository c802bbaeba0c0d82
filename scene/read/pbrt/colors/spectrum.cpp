#include "scene/read/pbrt/colors/spectrum.h"

#include <algorithm>
#include <cmath>

#include "scene/read/pbrt/colors/cie.h"
#include "scene/read/pbrt/syntax/text_file.h"

namespace bnvpl::pbrt {

namespace {

const Spectrum& d65() {
  static const Spectrum spectrum = daylight(6504.0);
  return spectrum;
}

// Integrals of term(wavelength) times the observer's colour matching functions.
template <typename Term>
Xyz integral(const Term& term) {
  Xyz sum{};
  for (size_t i = 0; i < kObserver.size(); ++i) {
    const double value = term(kFirstNm + kStepNm * double(i));
    for (size_t c = 0; c < 3; ++c) sum[c] += kObserver[i][c] * value;
  }
  return sum;
}

Xyz scaled(Xyz xyz, double by) {
  for (double& v : xyz) v *= by;
  return xyz;
}

}  // namespace

double Spectrum::at(double wavelength) const {
  const auto above = std::upper_bound(nm.begin(), nm.end(), wavelength);
  if (above == nm.begin()) return constantBeyond ? value.front() : 0.0;
  if (above == nm.end()) return constantBeyond || wavelength == nm.back() ? value.back() : 0.0;
  const auto i = static_cast<size_t>(above - nm.begin());
  const double t = (wavelength - nm[i - 1]) / (nm[i] - nm[i - 1]);
  return (1.0 - t) * value[i - 1] + t * value[i];
}

std::optional<Spectrum> spectrumOf(const std::vector<double>& pairs) {
  if (pairs.empty() || pairs.size() % 2 != 0) return std::nullopt;
  Spectrum s;
  s.constantBeyond = false;
  for (size_t i = 0; i < pairs.size(); i += 2) {
    if (!s.nm.empty() && !(pairs[i] > s.nm.back())) return std::nullopt;
    if (pairs[i + 1] < 0.0) return std::nullopt;
    s.nm.push_back(pairs[i]);
    s.value.push_back(pairs[i + 1]);
  }
  return s;
}

Spectrum readSpd(const fs::path& file) {
  const std::string text = readPacked(file), name = file.string();
  Lexer lexer(name, text);
  std::vector<double> numbers;
  for (Token t = lexer.next(); t.kind != Token::Kind::End; t = lexer.next()) {
    double number;
    if (t.kind != Token::Kind::Word || !toNumber(t.text, number))
      failAt(t.place, "a spectrum is pairs of wavelength (nm) and value");
    numbers.push_back(number);
  }
  std::optional<Spectrum> spectrum = spectrumOf(numbers);
  if (!spectrum)
    throw InputError(
        file,
        "is no spectrum: pairs of rising wavelength (nm) and value, not negative, are needed");
  return *spectrum;
}

Spectrum blackbody(double kelvin) {
  constexpr double kSecond = 1.438776877e7;  // nm K, second radiation constant
  Spectrum s;
  for (size_t i = 0; i < kObserver.size(); ++i) {
    const double nm = kFirstNm + kStepNm * double(i);
    s.nm.push_back(nm);
    // Planck's law relative to 560 nm, so that low temperatures do not underflow.
    const double x = kSecond / (nm * kelvin), x560 = kSecond / (560.0 * kelvin);
    s.value.push_back(std::pow(560.0 / nm, 5.0) * std::exp(x560 - x) * -std::expm1(-x560) /
                      -std::expm1(-x));
  }
  return s;
}

// CIE 15: the chromaticity of daylight, and the weights of the components that give it.
Spectrum daylight(double kelvin) {
  if (kelvin < 4000.0) return blackbody(kelvin);
  const double t = std::min(kelvin, 25000.0), t2 = t * t, t3 = t2 * t;
  const double x = t <= 7000.0 ? -4.6070e9 / t3 + 2.9678e6 / t2 + 0.09911e3 / t + 0.244063
                               : -2.0064e9 / t3 + 1.9018e6 / t2 + 0.24748e3 / t + 0.237040;
  const double y = -3.0 * x * x + 2.870 * x - 0.275;
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
  const double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
  Spectrum s;
  for (size_t i = 0; i < kDaylight.size(); ++i) {
    s.nm.push_back(kFirstNm + 2.0 * kStepNm * double(i));
    s.value.push_back(kDaylight[i][0] + m1 * kDaylight[i][1] + m2 * kDaylight[i][2]);
  }
  return s;
}

Xyz xyzOfLight(const Spectrum& light) {
  const Xyz sum = integral([&](double nm) { return light.at(nm); });
  return sum[1] > 0.0 ? scaled(sum, 1.0 / sum[1]) : Xyz{};
}

Xyz xyzUnderD65(const Spectrum& s) {
  static const double y = integral([](double nm) { return d65().at(nm); })[1];
  return scaled(integral([&](double nm) { return d65().at(nm) * s.at(nm); }), 1.0 / y);
}

double metalReflectance(double eta, double k) {
  return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

MetalRgb metalRgb(const Spectrum& eta, const Spectrum& k) {
  Spectrum reflectance;
  for (size_t i = 0; i < kObserver.size(); ++i) {
    const double nm = kFirstNm + kStepNm * double(i);
    reflectance.nm.push_back(nm);
    reflectance.value.push_back(metalReflectance(eta.at(nm), k.at(nm)));
  }
  const Vec3 etaRgb = srgbOf(xyzUnderD65(eta)), target = srgbOf(xyzUnderD65(reflectance));
  constexpr double kMinEta = 0.05, kMaxReflectance = 0.999;
  MetalRgb metal;
  for (size_t c = 0; c < 3; ++c) {
    const double f = std::clamp(double{target[c]}, 0.0, kMaxReflectance);
    double n = std::max(double{etaRgb[c]}, kMinEta);
    double k2 = (f * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1.0 - f);
    if (k2 < 0.0) {  // eta alone reflects more: k is 0, and eta solves for f
      n = (1.0 + std::sqrt(f)) / (1.0 - std::sqrt(f));
      k2 = 0.0;
    }
    metal.eta[c] = static_cast<float>(n);
    metal.k[c] = static_cast<float>(std::sqrt(k2));
  }
  return metal;
}

}  // namespace bnvpl::pbrt
