// What vpl-render writes and prints.
#pragma once

#include "formats/exr_io.h"
#include "tools/common/run_tool.h"
#include "tools/render/render.h"

namespace bnvpl {

struct ImagePaths {
  fs::path exr, png;  // png empty: none
};

// The image, and its preview at --exposure; with what the summary says of them.
void addImages(OutputSet& files, const ImagePaths& paths, const Image& image, const Values& options,
               Summary& summary);
ExrPixelType pixelTypeOf(const Values& options);

void reportRender(const RenderResult& result, const Values& options, Summary& summary);

}  // namespace bnvpl
