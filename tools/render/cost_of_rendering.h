// --estimate of vpl-render.
#pragma once

#include "tools/common/stage/cost.h"
#include "tools/render/render.h"

namespace bnvpl {

// A film that the trial can hold, of the same shape and view.
Film filmToTry(const Film& film);

// The image that is asked for.
struct ImageToMake {
  const Film& film;
  const Given& given;     // options as typed
  const Values& options;  // and resolved
  bool apart = false;     // in shards
};

// What render() will take, found by rendering fewer pixels and samples where these are many. The
// scene's film is filmToTry() of the image's.
Cost costOfRendering(const Accelerator& accel, const LightSet& lights, const VplTable& lit,
                     const ImageToMake& image, const ProgressFn& progress);

}  // namespace bnvpl
