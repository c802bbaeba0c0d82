// The camera of a scene as the header of an image describes it.
#pragma once

#include "formats/image/image.h"
#include "scene/scene.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

ImageCamera imageCameraOf(const Scene& scene);

// Both convert exactly, for shards. Throws InputError for JSON that is no camera.
Json toJson(const ImageCamera& camera);
ImageCamera imageCameraOf(const Json& json);

}  // namespace bnvpl
