// Reads [film] and [camera] of a TOML file.
#pragma once

#include "core/sampling.h"
#include "scene/read/toml/toml_section.h"
#include "scene/scene.h"

namespace bnvpl {

struct TomlView {
  Film film;
  FilePoint position{};  // position of the camera
  Camera camera;         // everything but its position
};

// Both sections must exist; `mirrored` is the default of the camera's 'mirrored'. Throws
// InputError.
TomlView readTomlView(const fs::path& file, const toml::table& root, bool mirrored = false);

inline float radians(double degrees) { return static_cast<float>(degrees) * (kPi / 180.0f); }

}  // namespace bnvpl
