// Files and summary of vpl-render.
#pragma once

#include "formats/image/exr_io.h"
#include "tools/common/run/run_tool.h"
#include "tools/render/render.h"

namespace bnvpl {

struct ImagePaths {
  fs::path exr, png;  // png is empty if no preview is wanted
};

// Memory of an image that shows this many light groups, bytes per pixel.
double bytesPerPixelOf(const Values& options, size_t groups);

// Adds the image and its preview at --exposure to the files, and both to the summary.
void addImages(OutputSet& files, const ImagePaths& paths, const Image& image, const Values& options,
               Summary& summary);
// Replaces the preview by one of the image so far.
void renewPreview(const fs::path& png, const Image& image, const Values& options);
ExrPixelType pixelTypeOf(const Values& options);

// Options that must not change when a run is resumed. The number of passes may.
Json resumableOptions(const Values& options);
// Options that reproduce the image, with the number of passes that were rendered.
Values optionsMade(const RenderResult& result, const Given& given);
// Sets the attributes of the image: samples, passes, provenance, and the hash of all.
void finishImage(RenderResult& result, const Values& made, const std::string& provenance);
// Adds the layers to the record of a shard: shards of one run must have the same.
Json withLayers(Json run, const Values& options);
// What vpl-merge needs of a shard's run besides its sums, and back.
Json sourcesOf(const RenderResult& result);
void takeSources(const Json& sources, RenderResult& result);
// Warns of options that were given and had no effect in this scene.
void warnOfIdle(const RenderResult& result, const Given& given);
void reportRender(const RenderResult& result, const Values& options, Summary& summary);

}  // namespace bnvpl
