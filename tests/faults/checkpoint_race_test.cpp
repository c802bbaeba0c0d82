// Runs of one command share a checkpoint: each begins while another saves its work or ends.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "tools/common/run/checkpoint.h"

namespace bnvpl {
namespace {

// What stands at the name is replaced and removed at any moment. A run finds a state that was saved
// whole, or none.
TEST(SharedCheckpoint, ThreadsMayReplaceOrRemoveItAsItIsOpened) {
  const fs::path folder = fs::temp_directory_path() / ("bnvpl-shared-" + std::to_string(getpid()));
  fs::create_directories(folder);
  CheckpointOptions options;
  options.file = folder / "work";
  const Json run{{"tool", "vpl-x"}};
  std::string small, large;
  for (std::string* bytes : {&small, &large}) {
    Checkpoint checkpoint(options, run);
    checkpoint.controls().save(std::string(bytes == &small ? 10 : 100000, 's'));
    std::ifstream in(options.file, std::ios::binary);
    bytes->assign(std::istreambuf_iterator<char>(in), {});
  }
  std::atomic<bool> done{false};
  std::atomic<int> replaced{0};
  std::thread others([&] {
    for (int i = 0; !done; ++i) {
      std::ofstream(folder / "next", std::ios::binary) << (i % 2 == 0 ? small : large);
      fs::rename(folder / "next", options.file);
      if (i % 3 == 0) fs::remove(options.file);
      ++replaced;
    }
  });
  int resumed = 0;
  for (int i = 0; i < 3000; ++i) {
    try {
      const std::string state = Checkpoint(options, run).controls().state;
      EXPECT_TRUE(state.empty() || state.size() == 10 || state.size() == 100000);
      resumed += state.empty() ? 0 : 1;
    } catch (const std::exception& e) {
      ADD_FAILURE() << e.what();
      break;
    }
  }
  done = true;
  others.join();
  EXPECT_GT(resumed, 0);
  EXPECT_GT(replaced, 100);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace bnvpl
