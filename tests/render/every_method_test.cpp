// What holds for every method of --gather and --compensate: an image has the same bytes for any
// number of threads, and as a whole or in shards.
#include "tests/support/gather_checks.h"
#include "tools/render/compensate/compensate.h"

namespace bnvpl::test {
namespace {

template <typename Methods>
std::vector<std::string> namesOf(const Methods& methods) {
  std::vector<std::string> names;
  for (const auto* method : methods) names.emplace_back(method->name);
  return names;
}

std::string testName(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

class EveryGather : public testing::TestWithParam<std::string> {};
const Given kTwoSamples{{"spp", "2"}};  // a pixel's sum needs two
TEST_P(EveryGather, IsTheSameForAnyThreads) {
  expectSameBytesForAnyThreads(GetParam(), kTwoSamples);
}
TEST_P(EveryGather, IsTheSameInShards) { expectSameBytesInShards(GetParam(), kTwoSamples); }
INSTANTIATE_TEST_SUITE_P(All, EveryGather, testing::ValuesIn(namesOf(gatherMethods())), testName);

// The clamp removes enough light for compensation to matter.
class EveryCompensation : public testing::TestWithParam<std::string> {
 protected:
  Given options() const { return {{"compensate", GetParam()}, {"clamp", "2"}, {"spp", "2"}}; }
};
TEST_P(EveryCompensation, IsTheSameForAnyThreads) {
  expectSameBytesForAnyThreads("tilecuts", options());
}
TEST_P(EveryCompensation, IsTheSameInShards) { expectSameBytesInShards("tilecuts", options()); }
INSTANTIATE_TEST_SUITE_P(All, EveryCompensation, testing::ValuesIn(namesOf(compensateMethods())),
                         testName);

}  // namespace
}  // namespace bnvpl::test
