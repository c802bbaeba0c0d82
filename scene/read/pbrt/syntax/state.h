// pbrt's graphics state at a place in the file.
#pragma once

#include "scene/read/pbrt/syntax/description.h"
#include "scene/read/pbrt/syntax/transform.h"

namespace bnvpl::pbrt {

struct State {
  Affine transform;             // at the opening of the shutter
  bool transformsStart = true;  // whether ActiveTransform lets directives change it
  bool reverseOrientation = false;
  ColorSpace colorSpace = ColorSpace::Srgb;
  MaterialRef material;
  uint32_t areaLight = kNone;
  bool hasMedium = false;
  std::map<std::string, std::shared_ptr<const Params>> attributes;  // by target: shape, light, ...
};

// The stack of graphics states, and named coordinate systems.
class States {
 public:
  State& now() { return now_; }
  const State& now() const { return now_; }
  // Throws InputError at a depth that only mistakes reach.
  void push(const Place& place);
  // `what` opens such a block: "AttributeBegin". Throws InputError where none is open.
  void pop(const Place& place, const char* what);
  void transformBy(const Place& place, const Affine& by);
  void setTransform(const Place& place, const Affine& to);
  size_t depth() const { return stack_.size(); }
  void requireClosed(const Place& end) const;

  std::map<std::string, Affine> coordinateSystems;

 private:
  struct Saved {
    State state;
    Place place;
  };
  State now_;
  std::vector<Saved> stack_;
};

}  // namespace bnvpl::pbrt
