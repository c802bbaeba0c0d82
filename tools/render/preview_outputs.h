// What vpl-render shows while it renders.
#pragma once

#include "tools/render/outputs.h"
#include "tools/render/preview/live_viewer.h"

namespace bnvpl {

// Overwrites --png while passes are rendered, and shows the film in a viewer, if there is one. The
// options must outlive it.
FilmPreview previewTo(const ImagePaths& paths, const Values& options, LiveViewer* viewer);
// Shows the image as it is written, and says in the summary whether a viewer was there.
void showFinished(LiveViewer& viewer, const ViewerAddress& address, const Image& image,
                  Summary& summary);

}  // namespace bnvpl
