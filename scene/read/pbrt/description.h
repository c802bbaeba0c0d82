// What a pbrt file says, directive by directive, before anything is made of it: the parser
// (parser.h) fills a Description, build.h makes a scene of it.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "scene/read/pbrt/params.h"
#include "scene/scene.h"

namespace bnvpl::pbrt {

// A directive with a type and parameters: Shape "sphere" "float radius" 2.
struct Entity {
  std::string type;
  Params params;
  Place place;
  ColorSpace colorSpace = ColorSpace::Srgb;  // of what it gives without a colour
};

// A named material, or, where the name is empty, a number in Description::materials; kNone: pbrt's
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
  uint32_t areaLight = kNone;  // in Description::areaLights
  bool hasMedium = false;      // a medium on either side
};

struct TextureEntity : Entity {
  bool isSpectrum = true;  // else float
  Affine worldFromTexture;
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
  std::deque<std::string> files;  // names of all that were read, the scene's first
  Entity camera{"perspective", {}, {}}, film{"rgb", {}, {}};
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

// What was ignored or approximated, each once however often it occurs.
class Notes {
 public:
  // `text` is the whole story but for the place, which is that of the first of equal texts.
  void add(const Place& place, const std::string& text);
  // "room.pbrt:3:1: text", and how many more there are; in the order of adding.
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
