#include "scene/read/pbrt/syntax/state.h"

namespace bnvpl::pbrt {

namespace {
constexpr size_t kMaxAttributeDepth = 1000;  // nested AttributeBegin and the like
}

void States::push(const Place& place) {
  if (stack_.size() == kMaxAttributeDepth)
    failAt(place, "more than 1000 blocks lie within each other; close some");
  stack_.push_back({now_, place});
}

void States::pop(const Place& place, const char* what) {
  if (stack_.empty()) failAt(place, std::string("closes what no ") + what + " has opened");
  now_ = std::move(stack_.back().state);
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
