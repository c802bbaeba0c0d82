// The stage vpl-render without files: a scene and lit VPLs -> an image with layers.
#pragma once

#include <optional>

#include "core/progress.h"
#include "core/resume.h"
#include "formats/image.h"
#include "tools/render/film/passes.h"
#include "tools/render/integrator/integrator.h"

namespace bnvpl {

// spp, time, target-error, passes, adaptive, seed, only, layers, integrator, gather, compensate,
// and the methods' own.
const StageSpec& renderSpec();
// The values of a run. With --time, --target-error or --passes, --spp is the most samples, and no
// limit unless it is given. Throws UsageError.
Values resolveRender(const Given& given);
// Of these values; none where --spp says all. Throws UsageError.
std::optional<Budget> budgetOf(const Values& options);
const IntegratorMethod& integratorOf(const Values& options);

// By --layers. Throws UsageError.
std::vector<const Layer*> layersOf(const Values& options);

// Samples and photons that progress will count; 0: nobody knows.
uint64_t renderWork(const Scene& scene, const Values& options);

struct RenderResult {
  Image image;
  FilmStats stats;
  size_t vpls = 0;                    // with flux
  size_t lamps = 0, sparseLamps = 0;  // see Integrator
  std::optional<PassesDone> passes;   // if there is a budget
};

// What finds the light of render(); `probe`: where nothing but the cost is asked for.
Integrator makeIntegrator(const RayScene& rays, const LightSet& lights, const VplTable& lit,
                          const Values& options, const ProgressFn& progress,
                          CostProbe* probe = nullptr);
// Its samples alone, `spp` a pixel, for who asks what they cost.
void renderSamples(const RayScene& rays, const Integrator& integrator, const Values& options,
                   uint32_t spp, const ProgressFn& progress, const Resume& resume);

// The image that shards have made together, `film` being theirs; the summary's `vpls` stays 0.
RenderResult joinRendered(const Film& film, const Values& options, const ShardSource& source);

// Of the film in the scene. `lit`: of stage Lit; without rows where the integrator needs none. A
// pure function: any number of threads, and any interruption that `resume` mends, gives the same
// bytes; with a budget for the same number of passes. `preview` is for budgets.
RenderResult render(const RayScene& rays, const LightSet& lights, const VplTable& lit,
                    const Values& options, const ProgressFn& progress = {},
                    const Resume& resume = {}, const PreviewFn& preview = {});

}  // namespace bnvpl
