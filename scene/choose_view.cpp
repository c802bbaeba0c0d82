#include "scene/choose_view.h"

#include <algorithm>
#include <charconv>

#include "scene/read/toml/toml_view.h"

namespace bnvpl {

namespace {

void use(const View& view, Scene& scene) {
  scene.camera = view.camera;
  scene.film = view.film;
}

std::vector<size_t> numbersOf(const Scene& scene, const std::string& name) {
  std::vector<size_t> out;
  for (size_t i = 0; !name.empty() && i < scene.views.size(); ++i)
    if (scene.views[i].name == name) out.push_back(i);
  return out;
}

}  // namespace

void chooseCamera(const std::string& nameOrIndex, Scene& scene) {
  const std::string asked = "--camera '" + nameOrIndex + "': " + scene.name();
  const std::vector<size_t> named = numbersOf(scene, nameOrIndex);
  if (named.size() > 1) {
    std::string list;
    for (const size_t i : named) list += (list.empty() ? "" : ", ") + std::to_string(i);
    throw UsageError(asked + " has several cameras of this name; choose by number: " + list);
  }
  if (named.size() == 1) return use(scene.views[named[0]], scene);
  size_t index = 0;
  const char* end = nameOrIndex.data() + nameOrIndex.size();
  const auto [stop, error] = std::from_chars(nameOrIndex.data(), end, index);
  if (error == std::errc() && stop == end && index < scene.views.size())
    return use(scene.views[index], scene);
  throw UsageError(
      asked + " has no such camera; its " +
      (scene.views.size() == 1 ? "camera has the number " : "cameras have the numbers ") +
      cameraList(scene));
}

void useViewFile(const fs::path& file, Scene& scene) {
  const toml::table root = parseToml(file);
  const TomlSection top(file, "view", root, {"film", "camera"});
  const View own = scene.views.empty() ? View{"", scene.camera, scene.film} : scene.views.front();
  for (const char* section : {"film", "camera"}) tableOf(file, root, section);  // both must exist
  const TomlView view = readTomlView(file, root, own.camera.isMirrored());
  scene.film = view.film->over(own.film);
  scene.camera = *view.camera;
  scene.camera.position = fromOrigin(view.position, scene.origin);
  if (std::find(scene.files.begin(), scene.files.end(), file) == scene.files.end())
    scene.files.push_back(file);
}

std::string cameraList(const Scene& scene) {
  constexpr size_t kNamed = 12;
  std::string list;
  for (size_t i = 0; i < std::min(kNamed, scene.views.size()); ++i) {
    list += (i > 0 ? ", " : "") + std::to_string(i);
    if (!scene.views[i].name.empty()) list += " '" + scene.views[i].name + "'";
  }
  if (scene.views.size() > kNamed)
    list += " and " + std::to_string(scene.views.size() - kNamed) + " more";
  return list;
}

}  // namespace bnvpl
