// Indices of refraction by name; declared in spectrum.h.
#include <algorithm>

#include "scene/read/pbrt/colors/spectrum.h"

namespace bnvpl::pbrt {

namespace {

// Silver, aluminium, gold, copper and titanium dioxide from Palik, "Handbook of Optical Constants
// of Solids", in steps of 0.1 eV from 3.2 down to 1.5.
constexpr size_t kEnergies = 18;
using ByEnergy = std::array<double, kEnergies>;
struct Metal {
  const char* name;
  ByEnergy eta, k;
};
constexpr Metal kMetals[]{
    {"Ag",
     {.192, .173, .173, .160, .157, .144, .132, .130, .130, .129, .120, .121, .131, .140, .140,
      .148, .143, .145},
     {1.810, 1.950, 2.110, 2.260, 2.400, 2.560, 2.720, 2.880, 3.070, 3.250, 3.450, 3.660, 3.880,
      4.150, 4.440, 4.740, 5.090, 5.500}},
    {"Al",
     {.460, .490, .523, .558, .598, .644, .695, .755, .826, .912, 1.020, 1.150, 1.300, 1.490, 1.740,
      2.140, 2.630, 2.740},
     {4.710, 4.860, 5.020, 5.200, 5.380, 5.580, 5.800, 6.030, 6.280, 6.550, 6.850, 7.150, 7.480,
      7.820, 8.210, 8.570, 8.600, 8.310}},
    {"Au",
     {1.674, 1.658, 1.636, 1.616, 1.562, 1.426, 1.242, .916, .608, .402, .306, .236, .194, .166,
      .160, .164, .176, .188},
     {1.936, 1.956, 1.958, 1.940, 1.904, 1.846, 1.796, 1.840, 2.120, 2.540, 2.880, 2.970, 3.060,
      3.150, 3.800, 4.357, 4.860, 5.390}},
    {"Cu",
     {1.180, 1.175, 1.180, 1.175, 1.170, 1.160, 1.150, 1.135, 1.120, 1.040, .826, .468, .272, .214,
      .213, .223, .250, .260},
     {2.210, 2.130, 2.210, 2.289, 2.362, 2.433, 2.504, 2.564, 2.605, 2.583, 2.599, 2.809, 3.240,
      3.670, 4.050, 4.430, 4.817, 5.260}},
    {"TiO2",
     {3.49, 3.40, 3.24, 3.25, 3.19, 3.13, 3.09, 3.04, 3.01, 2.95, 2.94, 2.91, 2.88, 2.86, 2.84,
      2.82, 2.80, 2.79},
     {}},
    {"MgO",
     {1.766, 1.762, 1.759, 1.756, 1.754, 1.751, 1.748, 1.746, 1.744, 1.741, 1.739, 1.737, 1.735,
      1.734, 1.732, 1.730, 1.729, 1.727},
     {}},
};

Spectrum fromEnergies(const ByEnergy& values) {
  constexpr double kNmEv = 1239.841984;  // h c in nm eV
  Spectrum s;
  for (size_t i = 0; i < kEnergies; ++i) {
    s.nm.push_back(kNmEv / (3.2 - 0.1 * double(i)));
    s.value.push_back(values[i]);
  }
  return s;
}

// Brass, Cu70Zn30, from Querry 1985.
Spectrum brass(bool k) {
  return {{400, 450, 500, 550, 600, 650, 700, 800},
          k ? std::vector{1.805, 1.829, 2.250, 2.765, 3.253, 3.695, 4.106, 4.890}
            : std::vector{1.445, 1.094, 0.686, 0.527, 0.450, 0.444, 0.446, 0.473}};
}

// Schott glasses at the Fraunhofer lines F, d and C. pbrt's F5, F10 and F11 are SF5, SF10 and SF11.
struct Glass {
  const char* name;
  double f, d, c;
};
constexpr Glass kGlasses[]{
    {"BK7", 1.52238, 1.51680, 1.51432},   {"BAF10", 1.68001, 1.67003, 1.66578},
    {"FK51A", 1.49056, 1.48656, 1.48480}, {"LASF9", 1.86898, 1.85025, 1.84255},
    {"SF5", 1.68750, 1.67270, 1.66661},   {"SF10", 1.74648, 1.72825, 1.72085},
    {"SF11", 1.80645, 1.78472, 1.77599}};

bool isGlass(const std::string& name, const std::string& glass) {
  return name == "glass-" + glass ||
         (glass.starts_with("SF") && name == "glass-" + glass.substr(1));
}

}  // namespace

std::optional<Spectrum> namedSpectrum(const std::string& name) {
  for (const Glass& glass : kGlasses) {
    if (isGlass(name, glass.name))
      return Spectrum{{486.1, 587.6, 656.3}, {glass.f, glass.d, glass.c}};
  }
  for (const Metal& metal : kMetals) {
    const std::string stem = std::string("metal-") + metal.name;
    if (name == stem + "-eta") return fromEnergies(metal.eta);
    if (name == stem + "-k") return fromEnergies(metal.k);
  }
  if (name == "metal-CuZn-eta" || name == "metal-CuZn-k") return brass(name.ends_with("-k"));
  return std::nullopt;
}

}  // namespace bnvpl::pbrt
