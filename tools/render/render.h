// The stage vpl-render without its files: a scene and lit VPLs -> an image with layers.
#pragma once

#include <optional>

#include "core/progress.h"
#include "core/work_controls.h"
#include "formats/image/image.h"
#include "tools/render/film/passes/passes.h"
#include "tools/render/integrator/integrator_method.h"
#include "tools/render/render_options.h"

namespace bnvpl {

struct RenderResult {
  Image image;
  FilmStats stats;
  size_t vpls = 0, emissionPoints = 0;  // see Integrator
  std::vector<FilmCount> filmCounts = {};
  CausticStats caustics = {};
  std::vector<std::string_view> idle = {};  // options that had no effect
  std::vector<std::string> groups = {};     // light groups that the image shows
  std::optional<PassesDone> passes;         // set if there is a budget
  // Mean radiance that the power of the lights makes if it falls evenly on all surfaces and half of
  // it is reflected, W/(m2 sr); 0 if unknown.
  double evenRadiance = 0.0;
};

// Makes the integrator of render(). `trial` is set for a cost estimate.
Integrator makeIntegrator(const Accelerator& accel, const LightSet& lights, const VplTable& lit,
                          const Values& options, const ProgressFn& progress,
                          CostTrial* trial = nullptr);

// Renders the film of the scene. `lit` is of stage Lit, or empty if the integrator needs no VPLs. A
// pure function: neither threads nor interruptions change a byte, given the same number of passes
// if there is a budget. --time counts from `startS`, of nowS().
RenderResult render(const Accelerator& accel, const LightSet& lights, const VplTable& lit,
                    const Values& options, const ProgressFn& progress = {},
                    const WorkControls& controls = {}, const FilmPreview& preview = {},
                    double startS = nowS());

// Renders only samples, `spp` per pixel, for a cost estimate.
void renderSamples(const Accelerator& accel, const Integrator& integrator, const Values& options,
                   uint32_t spp, const ProgressFn& progress, const WorkControls& controls);

// Joins the shards of an image. `film` and `groups` are those of the shards. The result's counts of
// VPLs stay 0.
RenderResult joinRendered(const Film& film, const Values& options, const ShardSource& source,
                          const std::vector<std::string>& groups = {});

// Number of samples and photons that progress will count; 0 if unknown.
uint64_t renderWork(const Scene& scene, const Values& options);

}  // namespace bnvpl
