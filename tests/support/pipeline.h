// The stages in one process, for tests of what they compute together.
#pragma once

#include <memory>

#include "scene/load_scene.h"
#include "tools/eliminate/eliminate.h"
#include "tools/estimate/estimate.h"
#include "tools/place/place.h"
#include "tools/render/film/film.h"
#include "tools/render/integrator/light/light_tracer.h"
#include "transport/lights.h"

namespace bnvpl::test {

// A scene of the project with its acceleration structure, in an order that keeps references valid.
struct World {
  explicit World(const std::string& name) : World(loadScene(fs::path(BNVPL_SCENES_DIR) / name)) {}
  explicit World(Scene given) : scene(std::move(given)), rays(scene), lights(rays) {}
  Scene scene;
  RayScene rays;
  LightSet lights;
};

inline VplTable placeAndEliminate(const World& world, uint64_t candidates,
                                  const EliminateOptions& options) {
  PlaceOptions place;
  place.count = candidates;
  const VplTable all = placeFromCamera(world.rays, place).table;
  const EliminateResult kept = eliminate(all.position, all.normal, options);
  VplTable vpls;
  vpls.stage = VplStage::Eliminated;
  for (const uint32_t row : kept.rows) {
    vpls.position.push_back(all.position[row]);
    vpls.normal.push_back(all.normal[row]);
    vpls.albedo.push_back(all.albedo[row]);
    vpls.id.push_back(all.id[row]);
  }
  vpls.radius = kept.radius;
  vpls.rMax = kept.rMax;
  return vpls;
}

struct VplSettings {
  uint64_t candidates = 20000, vpls = 1000;
  Density density = Density::Local;
  EstimateOptions estimate{.photons = 300000};
  float clamp = 1.0f;
  bool nearField = false;
  unsigned nearFieldRays = 16;
  GatherOptions gather{.method = GatherMethod::All};
  FilmOptions film{.spp = 4};
};

inline VplTable lightUp(const World& world, const VplSettings& s) {
  VplTable vpls = placeAndEliminate(world, s.candidates, {.count = s.vpls, .density = s.density});
  estimateFlux(vpls, world.rays, world.lights, s.estimate);
  return vpls;
}

inline Image renderVpls(const World& world, const VplTable& lit, const VplSettings& s,
                        FilmStats& stats) {
  const VplLights vpls = makeVplLights(lit, world.rays, s.clamp);
  const Gatherer gatherer(world.rays, vpls, s.gather, s.film.seed);
  const NearField nearField(lit, world.rays, s.clamp);
  const VplIntegrator integrator(world.rays, world.lights, gatherer,
                                 s.nearField ? &nearField : nullptr, s.nearFieldRays, s.film.only);
  return renderFilm(world.scene, {[&](const TileSamples& tile) { integrator.render(tile); }},
                    s.film, stats);
}

inline Image renderPaths(const World& world, const FilmOptions& film, FilmStats& stats,
                         unsigned maxBounces = 32) {
  const PathTracer integrator(world.rays, world.lights, maxBounces, film.only);
  return renderFilm(world.scene, {[&](const TileSamples& tile) { integrator.render(tile); }}, film,
                    stats);
}

// Indirect light by photons that are connected with the camera.
inline Image renderPhotons(const World& world, const FilmOptions& film, FilmStats& stats,
                           unsigned maxBounces = 32, const Resume& resume = {}) {
  const PathTracer samples(world.rays, world.lights, maxBounces, film.only, false);
  const LightTracer photons(world.rays, world.lights, maxBounces, film.seed);
  return renderFilm(
      world.scene,
      {[&](const TileSamples& tile) { samples.render(tile); },
       [&](uint64_t begin, uint64_t end, Splats& out) { photons.follow(begin, end, out); }},
      film, stats, {}, resume);
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
