// Parts of a TileIntegrator, made as options ask for.
#pragma once

#include <memory>

#include "tools/render/film_rays.h"
#include "tools/render/integrator/integrator_method.h"
#include "tools/render/tile/tile_integrator.h"

namespace bnvpl {

// Adds the parts for direct light, with `lightRays` shadow rays from each sample. Adds nothing if
// the image shows only indirect light.
void addDirectLight(const IntegratorInputs& in, const Values& options, const FilmRays& filmRays,
                    const FilmPoints& filmPoints, unsigned lightRays, TileParts& out);
// Returns null if the scene cannot have caustics. `tileParts` has the rays that find the same
// light; `spp`: samples of a pixel. `bounces`: see Caustics.
std::unique_ptr<const Caustics> makeCaustics(const IntegratorInputs& in, const TileParts& tileParts,
                                             uint64_t photons, uint64_t spp, unsigned bounces);
ControlVariateFn makeControlVariate(const IntegratorInputs& in, const FilmPoints& filmPoints);
// Runs the pilot of --allocate.
SampleAllocation allocationOf(const IntegratorInputs& in, const Values& options,
                              const TileIntegrator& integrator);

}  // namespace bnvpl
