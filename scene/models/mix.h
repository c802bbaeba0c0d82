// A linear blend of two of Scene::materials: (1 - amount) of `first` plus `amount` of `second`.
// Both have smaller numbers than the mix, which uses nothing but their models. A point has at most
// kMaxLobes lobes; further ones are black, and reading a mix that may have more warns.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

inline constexpr uint32_t kMaxLobes = 8;

struct MixModel {
  static constexpr const char* kName = "mix";
  static constexpr uint32_t kHashId = 8;
  static constexpr uint32_t kLobes = 0;  // those of its parts
  uint32_t first = kNone, second = kNone;
  Scalar amount{0.5f};
};

template <Like<MixModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("first", m.first);
  fn("second", m.second);
  fn("amount", m.amount);
}

}  // namespace bnvpl
