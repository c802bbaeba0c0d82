// [[light]] of a scene.toml.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/toml/toml_file_names.h"

namespace bnvpl {

// Emissions of named materials, which must be known before the meshes are read. Returns the names.
// Throws InputError.
std::vector<std::string> readTomlEmissions(const fs::path& file, const toml::table& root,
                                           SceneBuilder& builder);
// All other lights. Throws InputError.
void readTomlLights(const fs::path& file, const toml::table& root, const FileNames& names,
                    SceneBuilder& builder);

// Adds a light that is a surface: a rectangle, disk or sphere. `number` counts the file's lights
// from 1. Returns false if `type` is none of them.
bool readTomlAreaLight(const fs::path& file, const TomlSection& s, const std::string& type,
                       size_t number, SceneBuilder& builder);

// Index into Scene::lightGroups of the key 'group', or 0 without it. Throws InputError.
uint32_t tomlLightGroup(const TomlSection& s, SceneBuilder& builder);

// The unit vector of 'direction', or from `position` to 'look_at'.
FilePoint tomlDirection(const TomlSection& s, const FilePoint& position);

}  // namespace bnvpl
