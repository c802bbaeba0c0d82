#include "core/work_controls.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>

#include "tests/support/threads.h"

namespace bnvpl {
namespace {

TEST(WorkControls, ThreadsRunEveryUnitOnceThoughEveryRoundPauses) {
  std::vector<uint8_t> done(1000);
  done[3] = done[999] = 1;
  std::vector<std::atomic<int>> ran(done.size());
  int saves = 0;
  WorkControls controls;
  controls.pause = [] { return true; };
  controls.save = [&](const std::string&) { ++saves; };
  test::withThreads(7, [&] {
    forUnitsLeft(
        done, controls, [&](size_t i) { ++ran[i]; }, [] { return std::string(); });
  });
  for (size_t i = 0; i < done.size(); ++i) {
    EXPECT_EQ(done[i], 1);
    EXPECT_EQ(ran[i], i == 3 || i == 999 ? 0 : 1) << i;
  }
  EXPECT_GT(saves, 1);
}

TEST(WorkControls, SavingSeesWhatIsDoneAndMayEndTheWork) {
  std::vector<uint8_t> done(1000);
  std::atomic<size_t> ran{0};
  WorkControls controls;
  controls.pause = [&] { return ran >= 10; };
  controls.save = [&](const std::string& state) {
    EXPECT_EQ(state, std::to_string(ran));
    throw InputError("enough");
  };
  EXPECT_THROW(forUnitsLeft(
                   done, controls, [&](size_t) { ++ran; },
                   [&] { return std::to_string(std::count(done.begin(), done.end(), 1)); }),
               InputError);
  EXPECT_GE(ran, 10u);
  EXPECT_LT(ran, 1000u);
}

TEST(WorkControls, NothingLeftSavesNothing) {
  std::vector<uint8_t> done(5);
  WorkControls controls;
  std::atomic<size_t> ran = 0;  // every thread calls pause()
  controls.pause = [&] { return ++ran == 5; };
  controls.save = [](const std::string&) { FAIL(); };
  forUnitsLeft(
      done, controls, [](size_t) {}, [] { return std::string(); });
}

TEST(WorkControls, ArraysComeBackAndOtherLengthsAreRefused) {
  std::string bytes;
  appendArray(bytes, std::array{1, 2, 3});
  appendArray(bytes, std::array{0.5});
  std::array<int, 3> ints{};
  std::array<double, 1> doubles{};
  std::string_view rest = bytes;
  takeArray(rest, ints);
  EXPECT_THROW(requireAllTaken(rest), InputError);
  takeArray(rest, doubles);
  requireAllTaken(rest);
  EXPECT_EQ(ints, (std::array{1, 2, 3}));
  EXPECT_EQ(doubles[0], 0.5);
  EXPECT_THROW(takeArray(rest, doubles), InputError);
}

}  // namespace
}  // namespace bnvpl
