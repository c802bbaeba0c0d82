#include "scene/read/pbrt/syntax/state.h"

namespace bnvpl::pbrt {

namespace {
constexpr size_t kMaxAttributeDepth = 1000;  // nested AttributeBegin and the like
}

void States::push(const Place& place, bool transformOnly) {
  if (stack_.size() == kMaxAttributeDepth)
    failAt(place, "more than 1000 blocks lie within each other; close some");
  stack_.push_back({now_, transformOnly, place});
}

void States::pop(const Place& place, bool transformOnly, const char* what) {
  if (stack_.empty()) failAt(place, std::string("closes what no ") + what + " has opened");
  Saved& saved = stack_.back();
  if (saved.transformOnly != transformOnly)
    failAt(place, "closes another block than that of " + saved.place.text());
  if (transformOnly) {
    now_.transform = saved.state.transform;
    now_.transformsStart = saved.state.transformsStart;
  } else {
    now_ = std::move(saved.state);
  }
  stack_.pop_back();
}

void States::transformBy(const Place& place, const Affine& by) {
  setTransform(place, now_.transform * by);
}

void States::setTransform(const Place& place, const Affine& to) {
  if (!now_.transformsStart) return;
  if (!isFinite(to)) failAt(place, "leads to a transform beyond the range of numbers");
  now_.transform = to;
}

void States::requireClosed(const Place& end) const {
  if (!stack_.empty())
    failAt(end, "the file ends within the block that " + stack_.back().place.text() + " opens");
}

}  // namespace bnvpl::pbrt
