// The directives of a pbrt file before they are interpreted: the parser (parser.h) fills a
// Description, and build.h turns it into a scene.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "scene/read/pbrt/syntax/params.h"
#include "scene/scene.h"

namespace bnvpl::pbrt {

// A directive with a type and parameters: Shape "sphere" "float radius" 2.
struct Entity {
  std::string type;
  Params params;
  Place place;
  ColorSpace colorSpace = ColorSpace::Srgb;  // for colours that it leaves out
};

// The "string name" of a shape or light, which its Attribute may state, else its file, relative to
// the scene's folder, and line.
std::string nameOf(const Entity& entity, const fs::path& folder);

// A named material or, if the name is empty, a number in Description::materials; kNone is pbrt's
// default, grey.
struct MaterialRef {
  std::string name;
  uint32_t number = kNone;
  Place place;
  bool operator<(const MaterialRef& o) const {
    return std::tie(name, number) < std::tie(o.name, o.number);
  }
};

struct Shape : Entity {
  Affine worldFromObject;
  bool reverseOrientation = false;
  MaterialRef material;
  uint32_t areaLight = kNone;  // number in Description::areaLights
  bool hasMedium = false;      // whether either side has one
};

struct TextureEntity : Entity {
  bool isSpectrum = true;  // else a float texture
};

struct Light : Entity {
  Affine worldFromLight;
};

struct Object {  // ObjectBegin to ObjectEnd
  std::vector<Shape> shapes;
};
struct Instance {
  std::string object;
  Affine worldFromInstance;
  Place place;
};

struct Description {
  std::deque<std::string> files;  // names of all files read, the scene's first
  Entity camera{"perspective", {}, {}}, film{"rgb", {}, {}}, pixelFilter;
  Affine cameraFromWorld;
  std::vector<Entity> materials;
  std::map<std::string, Entity> namedMaterials, media;
  std::map<std::string, TextureEntity> textures;
  std::vector<Entity> areaLights;
  std::vector<Light> lights;
  std::vector<Shape> shapes;  // those outside of objects
  std::map<std::string, Object> objects;
  std::vector<Instance> instances;
};

// Notes of what was ignored or approximated. Equal notes are counted instead of repeated.
class Notes {
 public:
  // `text` is the message without its place. Of equal texts, the first place is kept.
  void add(const Place& place, const std::string& text);
  // Lines such as "room.pbrt:3:1: text (and 2 more)", in the order of add().
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    Place place;
    std::string text;
    size_t count;
  };
  std::vector<Entry> entries_;
  std::map<std::string, size_t> numberOf_;
};

}  // namespace bnvpl::pbrt
