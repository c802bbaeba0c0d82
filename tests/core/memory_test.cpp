// Memory that control groups leave, from files as the system shows them.
#include "core/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace bnvpl {
namespace {

constexpr uint64_t kMiB = 1 << 20;

class Groups : public ::testing::Test {
 protected:
  Groups() { fs::create_directories(root_); }
  ~Groups() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  void group(const std::string& path, const std::string& limit, uint64_t used,
             uint64_t cached) const {
    write(path + "/memory.max", limit + "\n");
    write(path + "/memory.current", std::to_string(used) + "\n");
    write(path + "/memory.stat", "anon 7\ninactive_file " + std::to_string(cached / 2) +
                                     "\nactive_file " + std::to_string(cached / 2) + "\n");
  }
  uint64_t leave(const std::string& groups) const {
    write("self", groups);
    return groupsLeave(root_, root_ / "self");
  }

  const fs::path root_ = fs::temp_directory_path() / ("bnvpl-groups-" + std::to_string(::getpid()));
};

TEST_F(Groups, FilesInMemoryAreNotUsed) {
  group("job", std::to_string(100 * kMiB), 100 * kMiB, 80 * kMiB);
  EXPECT_EQ(leave("0::/job\n"), 80 * kMiB);
  group("job", std::to_string(100 * kMiB), 120 * kMiB, 0);
  EXPECT_EQ(leave("0::/job\n"), 0u);
  EXPECT_EQ(leave("0::/other\n"), UINT64_MAX);
}

// Slurm limits the job, which holds the steps and their tasks.
TEST_F(Groups, LimitsOfThoseAboveCount) {
  group("job_7", std::to_string(64 * kMiB), 16 * kMiB, 0);
  group("job_7/step_0", std::to_string(96 * kMiB), 16 * kMiB, 0);
  group("job_7/step_0/task:0", "max", 16 * kMiB, 0);
  EXPECT_EQ(leave("0::/job_7/step_0/task:0\n"), 48 * kMiB);
}

TEST_F(Groups, OfVersionOne) {
  write("memory/a/b/memory.limit_in_bytes", std::to_string(10 * kMiB));
  write("memory/a/b/memory.usage_in_bytes", std::to_string(9 * kMiB));
  write("memory/a/b/memory.stat", "inactive_file 1\ntotal_inactive_file " +
                                      std::to_string(2 * kMiB) + "\ntotal_active_file " +
                                      std::to_string(kMiB) + "\n");
  EXPECT_EQ(leave("5:cpu:/a\n4:memory:/a/b\n"), 4 * kMiB);
}

}  // namespace
}  // namespace bnvpl
