// The camera and film that a scene is seen by, where its file has several or none will do.
#pragma once

#include "scene/scene.h"

namespace bnvpl {

// By name, or by number counted from 0 where no camera has that name. Throws UsageError, which
// lists the cameras.
void chooseCamera(const std::string& nameOrIndex, Scene& scene);

// Whether what is right in the world is left in the image, as in pbrt, whose space is left-handed.
bool isMirrored(const Camera& camera);

// By a TOML file of [film] and [camera], whose coordinates are the scene file's. It mirrors as the
// scene's first camera does unless it says otherwise, and becomes one of the scene's files. Throws
// InputError.
void useViewFile(const fs::path& file, Scene& scene);

// "0 'Door', 1 'Window'"
std::string cameraList(const Scene& scene);

}  // namespace bnvpl
