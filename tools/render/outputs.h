// What vpl-render writes and prints.
#pragma once

#include "formats/exr_io.h"
#include "tools/common/run_tool.h"
#include "tools/render/render.h"

namespace bnvpl {

struct ImagePaths {
  fs::path exr, png;  // png empty: none
};

// What an image takes in memory.
double bytesPerPixelOf(const Values& options);

// The image, and its preview at --exposure; with what the summary says of them.
void addImages(OutputSet& files, const ImagePaths& paths, const Image& image, const Values& options,
               Summary& summary);
// Renews the preview of an image under way; nothing without --png.
PreviewFn previewTo(const ImagePaths& paths, const Values& options);
ExrPixelType pixelTypeOf(const Values& options);

// Of a run that can be stopped and continued: by passes, whose number may be another then.
Json resumableOptions(const Values& options);
// The options that make this image again: with passes, as many of them as there were.
Values optionsMade(const RenderResult& result, const Given& given);
// Attributes: samples and passes, the history, and the hash of all.
void finishImage(RenderResult& result, const Values& made, const std::string& provenance);
// Of shards, which are of one run only where they are to show the same layers.
Json withLayers(Json run, const Values& options);
void reportRender(const RenderResult& result, const Values& options, Summary& summary);

}  // namespace bnvpl
