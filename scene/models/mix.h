// A linear blend of two of Scene::materials: (1 - amount) of `first` plus `amount` of `second`.
// Both have smaller numbers than the mix, which uses nothing but their models. Mixes of mixes hold
// at most kMaxLobes lobes; further lobes are black.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct MixModel {
  static constexpr const char* kName = "mix";
  static constexpr uint32_t kHashId = 8;
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
