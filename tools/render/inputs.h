// What vpl-render reads, and whether files and options fit together.
#pragma once

#include "formats/vpl/vpl_table.h"
#include "tools/common/stage/scene_options.h"
#include "tools/render/render.h"

namespace bnvpl {

struct RenderFiles {
  fs::path lit;  // empty for integrators that take no VPLs
  fs::path png;  // empty: no preview
  std::string viewer;  // address of --preview; empty: none
};

// Checks, before any work, what the command line says together. Throws UsageError.
void requireConsistent(const Values& options, const Given& given, const RenderFiles& files,
                       bool inShards);

// The lit VPLs; no rows where there is no file. Throws MemoryError where rendering them cannot fit,
// unless the run only predicts its cost.
VplTable readLit(const fs::path& lit, const Values& options, bool predictsCost);

// Gives the scene the film that the options ask for, and the options the film's filter where they
// name none. Throws UsageError for a crop beyond the film.
void resolveFilm(Given& given, Values& options, Scene& scene);

// Throws MemoryError if an image of this size cannot fit.
void requireMemoryForImage(const Scene& scene, const Values& options);

// Files that the image depends on.
std::vector<fs::path> filesRead(const Scene& scene, const RenderFiles& files);

// Throws InputError where the VPLs were not made on this scene. Warns where none of them has flux.
void checkLit(const Scene& scene, const VplTable& lit, const fs::path& file);

// Warns of light that the chosen integrator cannot find. Throws InputError for lights that do not
// fit VPLs.
void checkLights(const Scene& scene, const LightSet& lights, const Values& options,
                 const RenderFiles& files);

}  // namespace bnvpl
