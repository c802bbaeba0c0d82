// The stages in one process, for tests of their combined results.
#pragma once

#include <array>
#include <charconv>

#include "scene/load_scene.h"
#include "tools/eliminate/eliminate.h"
#include "tools/estimate/estimate.h"
#include "tools/place/place.h"
#include "tools/render/render.h"
#include "transport/lights/lights.h"

namespace bnvpl::test {

// A scene with its acceleration structure; the order of the members keeps references valid.
struct World {
  explicit World(const std::string& name) : World(loadScene(fs::path(BNVPL_SCENES_DIR) / name)) {}
  explicit World(Scene given) : scene(std::move(given)), accel(scene), lights(accel) {}
  Scene scene;
  Accelerator accel;
  LightSet lights;
};

// `options` followed by `more`; a later option overrides an earlier one of the same name.
inline Given with(Given options, const Given& more) {
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

// A number as a user types it: with the fewest digits that read back the same.
template <typename Number>
std::string typed(Number number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

inline PlaceResult placeVpls(const World& world, const Given& options) {
  return place({world.accel, world.lights, PlaceViews(world.scene)}, resolve(placeSpec(), options));
}
inline VplTable keepVpls(const VplTable& candidates, const Given& options) {
  return eliminate(candidates, resolve(eliminateSpec(), options));
}
inline EstimateResult lightVpls(const World& world, const VplTable& vpls, const Given& options,
                                const WorkControls& controls = {}) {
  return estimate(vpls, world.accel, world.lights, resolve(estimateSpec(), options), {}, controls);
}
inline RenderResult renderVpls(const World& world, const VplTable& lit, const Given& options,
                               const WorkControls& controls = {}) {
  return render(world.accel, world.lights, lit, resolveRender(options), {}, controls);
}
// Renders without VPLs, by the path tracer or the light tracer.
inline RenderResult renderWithout(const World& world, const std::string& integrator,
                                  const Given& options, const WorkControls& controls = {}) {
  return renderVpls(world, {}, with({{"integrator", integrator}}, options), controls);
}

// Collects the names of a stage's preparations in the order in which they begin.
struct Preparations {
  ProgressFn progress{[](uint64_t) {},
                      [this](std::string_view what, uint64_t) { names.emplace_back(what); }};
  std::vector<std::string> names;
};

// Small counts; every VPL is gathered, and only VPLs contribute indirect light. The time of many
// gathers grows with the emission points of a VPL.
inline const Given kFewCandidates{{"count", "20k"}};
inline const Given kFewVpls{{"count", "1000"}};
inline const Given kFewPhotons{{"photons", "300k"}, {"emit-points", "4"}};
inline const Given kPlainRender{{"gather", "all"}, {"compensate", "none"}, {"clamp", "1"},
                                {"spp", "4"},      {"allocate", "off"},    {"fireflies", "keep"}};
// The same for direct light alone, without the options of indirect light.
inline const Given kPlainDirect{{"compensate", "none"},
                                {"spp", "4"},
                                {"only", "direct"},
                                {"direct-samples", "1"},
                                {"fireflies", "keep"}};

// The stages from the scene to VPLs without flux, and with it; the options follow those above.
inline VplTable keptVpls(const World& world, const Given& eliminated, const Given& placed = {}) {
  const VplTable candidates = placeVpls(world, with(kFewCandidates, placed)).table;
  return keepVpls(candidates, with(kFewVpls, eliminated));
}
inline VplTable litVpls(const World& world, const Given& eliminated = {},
                        const Given& estimated = {}, const Given& placed = {}) {
  const VplTable vpls = keptVpls(world, eliminated, placed);
  return lightVpls(world, vpls, with(kFewPhotons, estimated)).table;
}

// Mean indirect light of an image.
inline double indirectByVpls(const World& world, const VplTable& lit, const Given& options) {
  const Given indirect = with(kPlainRender, {{"only", "indirect"}});
  return renderVpls(world, lit, with(indirect, options)).stats.indirect;
}
inline double indirectByPaths(const World& world, const Given& options) {
  return renderWithout(world, "path", with({{"only", "indirect"}}, options)).stats.indirect;
}

// Total flux of all VPLs in W, averaged over the channels.
inline double totalFlux(const VplTable& lit) {
  double sum = 0.0;
  for (const Vec3 f : lit.flux) sum += double{mean(f)};
  return sum;
}

// Mean over pixels and channels of a layer ("" for R, G, B).
inline double meanOf(const Image& image, const std::string& prefix = "") {
  double sum = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    for (const float v : *image.find(prefix + c)) sum += double{v};
  }
  return sum / (3.0 * double(image.pixelCount()));
}

}  // namespace bnvpl::test
