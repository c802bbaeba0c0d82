// Reads [film] and [camera] of a TOML file.
#pragma once

#include <optional>

#include "core/sampling.h"
#include "scene/read/toml/toml_section.h"
#include "scene/scene.h"

namespace bnvpl {

// The keys of [film]: the size of a film, its filter, or both.
struct TomlFilm {
  std::optional<Film> size;
  std::optional<FilterSpec> filter;
  // The film with the keys in place of its own.
  Film over(const Film& film) const;
};

struct TomlView {
  std::optional<TomlFilm> film;
  FilePoint position{};          // position of the camera
  std::optional<Camera> camera;  // everything but its position
};

// The sections that the file has; `mirrored` is the default of the camera's 'mirrored'. Throws
// InputError.
TomlView readTomlView(const fs::path& file, const toml::table& root, bool mirrored = false);

inline float radians(double degrees) { return static_cast<float>(degrees) * (kPi / 180.0f); }

}  // namespace bnvpl
