// What pbrt's attributes say at a place of the file.
#pragma once

#include "scene/read/pbrt/description.h"
#include "scene/read/pbrt/transform.h"

namespace bnvpl::pbrt {

struct State {
  Affine transform;             // at the beginning of the shutter
  bool transformsStart = true;  // whether transforms change it: ActiveTransform
  bool reverseOrientation = false;
  ColorSpace colorSpace = ColorSpace::Srgb;
  MaterialRef material;
  uint32_t areaLight = kNone;
  bool hasMedium = false;
  std::map<std::string, std::shared_ptr<const Params>> attributes;  // by target: shape, light, ...
};

// The stack of states, and transforms by name.
class States {
 public:
  State& now() { return now_; }
  const State& now() const { return now_; }
  // Refused at a depth that only mistakes reach.
  void push(const Place& place, bool transformOnly = false);
  // `what` opened it: "AttributeBegin".
  void pop(const Place& place, bool transformOnly, const char* what);
  void transformBy(const Place& place, const Affine& by);
  void setTransform(const Place& place, const Affine& to);
  size_t depth() const { return stack_.size(); }
  void requireClosed(const Place& end) const;

  std::map<std::string, Affine> coordinateSystems;

 private:
  struct Saved {
    State state;
    bool transformOnly;
    Place place;
  };
  State now_;
  std::vector<Saved> stack_;
};

}  // namespace bnvpl::pbrt
