// Options of vpl-render: what they are, and what they say together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/image/image.h"
#include "scene/scene.h"
#include "tools/common/stage/method.h"
#include "tools/render/film/film.h"
#include "tools/render/film/passes/passes.h"
#include "tools/render/integrator/integrator_method.h"

namespace bnvpl {

// Options of the stage (stage_options.h) and of each method.
const StageSpec& renderSpec();
// Values of a run. With --time, --target-error or --passes, --spp is an upper limit if it is given.
// Throws UsageError.
Values resolveRender(const Given& given);
// The options as if the filter of the film had been given, unless another one was.
Given withFilterOf(const Film& film, Given given);
// The budget of the passes, or none if the image is rendered without passes. Throws UsageError.
std::optional<PassBudget> budgetOf(const Values& options);
// Samples per pixel in a pass, on average, unless a trial finds that fewer fit into --time.
uint64_t passSppOf(const Values& options);
const IntegratorMethod& integratorOf(const Values& options);

// Parses "X0,Y0,X1,Y1", a rectangle of pixels that is not empty. Throws UsageError.
PixelBox parseCrop(const std::string& text);
// The pixels that --crop names, or none without it. Throws UsageError if the film has others.
std::optional<PixelBox> cropOf(const Values& options, const Film& film);

// Layers that --layers names. Throws UsageError.
std::vector<const Layer*> layersOf(const Values& options);

// Light groups that the image shows; empty unless --layers asks for them. Throws InputError if no
// light of the scene has one, and UsageError if the gather does not tell groups apart.
std::vector<std::string> lightGroupsOf(const Values& options, const Scene& scene);

// Options of the film, but for its crop, its light groups and its layers of first hits.
FilmOptions filmOptionsOf(const Values& options);
// Whether the integrator traces photons for this image.
bool sendsPhotons(const Values& options);
// Options by which images of passes are prepared: --spp only limits their number, which changes
// neither what they have in common nor the state of a checkpoint.
Values preparingOptions(Values options);

}  // namespace bnvpl
