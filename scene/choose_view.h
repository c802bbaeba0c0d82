// Chooses the camera and film of a scene: one of the scene's own, or those of a separate view file.
#pragma once

#include "scene/scene.h"

namespace bnvpl {

// Selects a camera of the scene by name, or by number from 0 if no camera has that name. Throws
// UsageError, which lists the cameras, also where several have the name.
void chooseCamera(const std::string& nameOrIndex, Scene& scene);

// Takes the view from a TOML file with [film] and [camera], in the coordinates of the scene file.
// The default of its 'mirrored' and of the film's keys is that of the scene's first camera. Adds
// the file to Scene::files. Throws InputError.
void useViewFile(const fs::path& file, Scene& scene);

// Lists the cameras, such as "0 'Door', 1 'Window'".
std::string cameraList(const Scene& scene);

}  // namespace bnvpl
