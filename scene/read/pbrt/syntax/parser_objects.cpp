// Directives of pbrt for what a scene holds: camera, materials, lights, shapes, objects and files.
#include <algorithm>
#include <utility>

#include "scene/read/pbrt/syntax/parser_class.h"

namespace bnvpl::pbrt {

void Parser::film(const Token& at) {
  requireAboveWorld(at);
  out_.film = entity(at);
  const std::string& type = out_.film.type;
  if (type != "rgb" && type != "gbuffer" && type != "spectral")
    notes_.add(at.place, "film '" + type + "' is unknown; it is taken as rgb");
}

void Parser::pixelFilter(const Token& at) {
  requireAboveWorld(at);
  out_.pixelFilter = entity(at);
}

void Parser::camera(const Token& at) {
  requireAboveWorld(at);
  out_.camera = entity(at);
  out_.cameraFromWorld = now().transform;
  const auto worldFromCamera = inverse(now().transform);
  if (!worldFromCamera) failAt(at.place, "the camera's transform has no inverse");
  states_.coordinateSystems["camera"] = *worldFromCamera;
}

void Parser::material(const Token& at) {
  out_.materials.push_back(entity(at, "material"));
  now().material = {"", static_cast<uint32_t>(out_.materials.size() - 1), at.place};
}

void Parser::namedMaterial(const Token& at) {
  now().material = {string("a name in quotes"), kNone, at.place};
}

void Parser::makeNamedMaterial(const Token& at) {
  const std::string name = string("a name in quotes");
  Entity e;
  e.place = at.place;
  e.colorSpace = now().colorSpace;
  e.params = readParams(*tokens_, now().colorSpace, notes_);
  const auto set = now().attributes.find("material");
  if (set != now().attributes.end()) e.params.setFallback(set->second);
  if (!e.params.has("type")) failAt(at.place, "material '" + name + "' needs a \"string type\"");
  e.type = e.params.text("type");
  if (!out_.namedMaterials.try_emplace(name, std::move(e)).second)
    failAt(at.place, "material '" + name + "' is there already; choose another name");
}

void Parser::makeNamedMedium(const Token& at) {
  const std::string name = string("a name in quotes");
  Entity e;
  e.place = at.place;
  e.params = readParams(*tokens_, now().colorSpace, notes_);
  e.type = e.params.text("type");
  notes_.add(at.place, "MakeNamedMedium: media are not rendered; the space is taken as empty");
  out_.media.try_emplace(name, std::move(e));
}

void Parser::texture(const Token& at) {
  const std::string name = string("a name in quotes"), type = string("spectrum or float");
  if (type != "spectrum" && type != "float")
    failAt(at.place, "texture '" + name + "' must be a \"spectrum\" or \"float\" one");
  TextureEntity t{entity(at, "texture"), type == "spectrum"};
  // Spectrum and float textures have separate names.
  if (!out_.textures.try_emplace(type + " " + name, std::move(t)).second)
    failAt(at.place, type + " texture '" + name + "' is there already; choose another name");
}

void Parser::lightSource(const Token& at) {
  out_.lights.push_back({entity(at, "light"), now().transform});
}

void Parser::areaLightSource(const Token& at) {
  out_.areaLights.push_back(entity(at, "light"));
  now().areaLight = static_cast<uint32_t>(out_.areaLights.size() - 1);
}

void Parser::shape(const Token& at) {
  const State& s = now();
  Shape shape{entity(at, "shape"), s.transform, s.reverseOrientation,
              s.material,          s.areaLight, s.hasMedium};
  if (object_ && shape.areaLight != kNone) {
    notes_.add(at.place, "a lamp within an object does not shine: pbrt has no such lamps");
    shape.areaLight = kNone;
  }
  (object_ ? object_->shapes : out_.shapes).push_back(std::move(shape));
}

void Parser::objectBegin(const Token& at) {
  if (object_) failAt(at.place, "ObjectBegin stands within an object; close it by ObjectEnd");
  const std::string name = string("a name in quotes");
  const auto [it, isNew] = out_.objects.try_emplace(name);
  if (!isNew) failAt(at.place, "object '" + name + "' is there already; choose another name");
  states_.push(at.place);
  object_ = &it->second;
}

void Parser::objectEnd(const Token& at) {
  if (!object_) failAt(at.place, "ObjectEnd closes what no ObjectBegin has opened");
  states_.pop(at.place, "ObjectBegin");
  object_ = nullptr;
}

void Parser::objectInstance(const Token& at) {
  const std::string name = string("a name in quotes");
  if (object_) failAt(at.place, "an object cannot hold an ObjectInstance; pbrt nests none");
  out_.instances.push_back({name, now().transform, at.place});
}

// An option has a name without a type, and one value.
void Parser::option(const Token&) {
  string("a name in quotes");
  Token value = tokens_->next();
  if (value.kind == Token::Kind::Open)
    while (value.kind != Token::Kind::Close && value.kind != Token::Kind::End)
      value = tokens_->next();
  if (value.kind == Token::Kind::End)
    failAt(value.place, "the file ends where an Option needs a value");
}

void Parser::include(const Token& at) {
  const std::string name = string("a file in quotes");
  readFile((folder_ / name).lexically_normal(), &at.place);
}

void Parser::import(const Token& at) {
  states_.push(at.place);
  include(at);
  states_.pop(at.place, "Import");
}

}  // namespace bnvpl::pbrt
