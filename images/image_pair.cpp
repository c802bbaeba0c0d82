#include "images/image_pair.h"

namespace bnvpl {

ImagePair makePair(const fs::path& fileA, const Layer& a, const fs::path& fileB, const Layer& b,
                   const Layer* second, const Mask& mask) {
  if (second != nullptr) requireSameShape(fileB, b, "its second half", *second);
  requireSameShape(fileA, a, fileB.string(), b);
  requireFinite(fileA, a);
  requireFinite(fileB, b);
  return {a, b, second != nullptr ? *second : b, mask, mask.sum(b.pixelCount())};
}

}  // namespace bnvpl
