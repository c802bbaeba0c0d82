// The stage vpl-render without files: a scene and lit VPLs -> an image with layers.
#pragma once

#include "core/progress.h"
#include "core/resume.h"
#include "formats/image.h"
#include "tools/render/film/film.h"

namespace bnvpl {

// spp, seed, only, layers, integrator, gather, compensate, and the methods' own.
const StageSpec& renderSpec();
const IntegratorMethod& integratorOf(const Values& options);

// By --layers. Throws UsageError.
std::vector<const Layer*> layersOf(const Values& options);

// Samples and photons that progress will count.
uint64_t renderWork(const Scene& scene, const Values& options);

struct RenderResult {
  Image image;
  FilmStats stats;
  size_t vpls = 0;  // with flux
};

// Of the film in the scene. `lit`: of stage Lit; without rows where the integrator needs none. A
// pure function: any number of threads, and any interruption that `resume` mends, gives the same
// bytes.
RenderResult render(const RayScene& rays, const LightSet& lights, const VplTable& lit,
                    const Values& options, const ProgressFn& progress = {},
                    const Resume& resume = {});

}  // namespace bnvpl
