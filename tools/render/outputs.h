// What vpl-render writes and prints.
#pragma once

#include "formats/exr_io.h"
#include "tools/common/run_tool.h"
#include "tools/render/render.h"

namespace bnvpl {

struct ImagePaths {
  fs::path exr, png;  // png empty: none
};

// The image, and its preview at `exposure` ("auto" or stops).
void addImages(OutputSet& files, const ImagePaths& paths, const Image& image, ExrPixelType pixels,
               const std::string& exposure);

void reportRender(const RenderResult& result, const Values& options, Summary& summary);

}  // namespace bnvpl
