// [film] and [camera] of a TOML file.
#pragma once

#include "core/sampling.h"
#include "scene/read/toml/toml_section.h"
#include "scene/scene.h"

namespace bnvpl {

struct TomlView {
  Film film;
  FilePoint position{};  // of the camera
  Camera camera;         // but for its position
};

// Both sections must be there. Throws InputError.
TomlView readTomlView(const fs::path& file, const toml::table& root);

inline float radians(double degrees) { return static_cast<float>(degrees) * (kPi / 180.0f); }

}  // namespace bnvpl
