// Numbers of a [[material]] that its model cannot use.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/toml/toml_section.h"

namespace bnvpl {

// Warns, with the line, of each number that the model clamps when it is evaluated
// (scene/models/parameters.h), and says what is used. Factors of textures may be anything: only
// their product is clamped.
void warnOfClamped(const TomlSection& s, const Material& m, SceneBuilder& builder);

}  // namespace bnvpl
