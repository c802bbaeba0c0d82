// What finds the radiance along camera rays: the slot of --integrator. A method is a folder beside
// this file.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "core/progress.h"
#include "core/random.h"
#include "formats/vpl_table.h"
#include "tools/common/method.h"
#include "tools/render/integrator/splats.h"
#include "tools/render/tile.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

// What photons bring to a pixel, W/(m2 sr).
struct PhotonLight {
  Vec3 all;
  std::array<Vec3, 2> brightest;  // of single photons, by the mean of the channels
};

struct RadianceSample {
  Vec3 direct;    // at most mirrors, glass and sharp lobes between the camera and the first rough
                  // vertex, and nothing between that and a light
  Vec3 seen;      // of a light that the camera ray itself meets; part of `direct`
  Vec3 indirect;  // everything else
  PhotonLight photons;  // of the pixel; part of `indirect`
  Vec3 clamped;         // indirect light that the bound on 1/d^2 removed from the VPLs
  Vec3 compensated;     // indirect light that sampled rays brought instead; part of `indirect`
  Vec3 albedo, normal;  // of the first rough vertex
  float depth = 0.0f;   // of the first hit along the viewing axis; 0: none
  uint32_t cut = 0, shadowRays = 0;
};

// One sample of a pixel.
struct CameraSample {
  Vec3 origin, direction;
  Rng rng{0, 0};
  RadianceSample radiance;  // what an integrator finds
};

struct TileSamples : TileSlots {
  std::span<CameraSample> samples;
};

enum class Only { Everything, Direct, Indirect };

// Thread-safe and immutable once made.
struct Integrator {
  // Finds the radiance of all samples of a tile.
  std::function<void(const TileSamples& tile)> samples;
  // Photons that bring indirect light besides, as many as samples; none where it is empty.
  Splatter photons = {};
  bool wholePixels = false;  // a tile is to hold every sample of its pixels, not some at a time
  size_t vpls = 0;           // with flux
  // Lamps that caustic photons could be sent from, and those whose photons are too few.
  size_t lamps = 0, sparseLamps = 0;
};

// Borrowed until the image is done.
struct IntegratorInputs {
  const RayScene& rays;
  const LightSet& lights;
  const VplTable& lit;  // of stage Lit; without rows unless the method needs VPLs
  uint64_t seed;
  Only only;
  const ProgressFn& progress;  // of preparations
};

// Of integrators that bring light by samples.
constexpr Option specksOption(std::string_view fallback) {
  return choiceOption(
      "specks", fallback, "spread|keep",
      "light that a single sample or photon finds far above all around it: spread over its "
      "surroundings, the energy as it was, or kept");
}

// Not of methods without the option.
inline bool spreadsSpecks(const Values& options) {
  return options.has("specks") && options.text("specks") == "spread";
}

struct IntegratorMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  Integrator (*make)(const IntegratorInputs&, const Values&);
  bool needsVpls = false;
  bool photons = false;  // sends photons for indirect light
  bool gathers = false;  // VPLs shine in its image: --gather and --compensate count
};
std::span<const IntegratorMethod* const> integratorMethods();

}  // namespace bnvpl
