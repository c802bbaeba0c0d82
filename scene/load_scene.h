// Scene files -> Scene. A format is a folder of scene/read/ and one line of the list in
// load_scene.cpp.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace bnvpl {

// Values for ${NAME} in file names of a scene file; environment variables are asked second.
using Defines = std::map<std::string, std::string>;

// Reads a scene and everything that it names; the extension says the format. What could be
// repaired is in Scene::warnings. Throws InputError with file, line where there is one, problem and
// cure; MemoryError or std::bad_alloc when it does not fit.
Scene loadScene(const fs::path& path, const Defines& defines = {});

}  // namespace bnvpl
