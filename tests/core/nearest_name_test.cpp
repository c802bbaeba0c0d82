#include "core/nearest_name.h"

#include <gtest/gtest.h>

namespace bnvpl {
namespace {

TEST(NearestName, CountsEdits) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("photons", "photons"), 0u);
  EXPECT_EQ(editDistance("photns", "photons"), 1u);
  EXPECT_EQ(editDistance("photonss", "photons"), 1u);
  EXPECT_EQ(editDistance("fotons", "photons"), 2u);
  EXPECT_EQ(editDistance("heigth", "height"), 1u);  // a swap
  EXPECT_EQ(editDistance("ca", "abc"), 3u);         // no letter is edited twice
}

TEST(NearestName, IsFoundOnlyIfItIsNear) {
  const std::vector<std::string> names{"count", "photons", "radius", "seed"};
  EXPECT_EQ(nearestName("photon", names), "photons");
  EXPECT_EQ(nearestName("sede", names), "seed");
  EXPECT_EQ(nearestName("gather", names), "");
  EXPECT_EQ(nearestName("x", {}), "");
  EXPECT_EQ(didYouMean("raduis", names, "", "--"), "; did you mean --radius?");
  EXPECT_EQ(didYouMean("gather", names), "");
  EXPECT_EQ(didYouMean("coutn", names, "use a or b"), "; did you mean count? Use a or b");
  EXPECT_EQ(didYouMean("gather", names, "use a or b"), "; use a or b");
}

}  // namespace
}  // namespace bnvpl
