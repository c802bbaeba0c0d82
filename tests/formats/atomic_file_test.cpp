// Output is whole or absent; leftovers of killed runs are removed.
#include "formats/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

using AtomicOutput = TestFolder;

void replaceBy(const fs::path& target, const std::string& bytes) {
  AtomicFile file(target);
  file.write(bytes);
  file.commit();
}

TEST_F(AtomicOutput, NothingIsReplacedBeforeCommit) {
  writeAll(at("a"), "old");
  {
    AtomicFile file(at("a"));
    file.write("new");
    EXPECT_EQ(readAll(at("a")), "old");
    EXPECT_EQ(fileCount(), 2u);
  }
  EXPECT_EQ(readAll(at("a")), "old");
  EXPECT_EQ(fileCount(), 1u);
  replaceBy(at("a"), "new");
  EXPECT_EQ(readAll(at("a")), "new");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(AtomicOutput, ASetIsReplacedTogether) {
  writeAll(at("product"), "old");
  {
    OutputSet set;
    set.add(at("product")).write("new");
    EXPECT_THROW(set.add(at("absent/companion")), OutputError);
  }
  EXPECT_EQ(readAll(at("product")), "old");
  OutputSet set;
  set.add(at("product")).write("new");
  set.add(at("companion")).write("new");
  EXPECT_FALSE(fs::exists(at("companion")));
  set.commit();
  EXPECT_EQ(readAll(at("product")) + readAll(at("companion")), "newnew");
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(AtomicOutput, WhatKilledRunsLeftIsRemovedAndNothingElse) {
  const std::string others[] = {"a.partial",      "a.partial-",    "a.partial-1",
                                "a.partial-1-",   "b.partial-1-2", "a.partial-1-2.txt",
                                "a.partial-1-2-3"};
  for (const std::string& name : others) writeAll(at(name), "of somebody else");
  writeAll(at("a.partial-1-2"), "abandoned");
  writeAll(at("a.partial-99999999-0"), "abandoned");
  writeAll(at("a.partial-3-4"), "of a run that lives");
  const int lock = ::open(at("a.partial-3-4").c_str(), O_RDWR);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  replaceBy(at("a"), "new");
  EXPECT_FALSE(fs::exists(at("a.partial-1-2")));
  EXPECT_FALSE(fs::exists(at("a.partial-99999999-0")));
  EXPECT_TRUE(fs::exists(at("a.partial-3-4")));
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(at(name))) << name;
  ::close(lock);
}

TEST_F(AtomicOutput, TwoOfOneTargetLeaveEachOtherAlone) {
  AtomicFile first(at("a")), second(at("a"));
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(readAll(at("a")), "first");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(AtomicOutput, ReadOnlyFilesAreKept) {
  if (::geteuid() == 0)
    GTEST_SKIP() << "root may write to them; faults_disk tries it as another user";
  writeAll(at("a"), "old");
  fs::permissions(at("a"), fs::perms::owner_read);
  EXPECT_THROW(AtomicFile{at("a")}, OutputError);
  EXPECT_EQ(fileCount(), 1u);
}

// The file at the end of a chain of links is replaced, and the links stay.
TEST_F(AtomicOutput, LinksAreFollowed) {
  fs::create_directories(at("far"));
  writeAll(at("far/a"), "old");
  fs::create_symlink("far/a", at("near"));
  fs::create_symlink(at("near"), at("link"));
  fs::create_symlink("far/new", at("dangling"));
  writeAll(at("far/a.partial-1-2"), "abandoned");
  replaceBy(at("link"), "new");
  EXPECT_EQ(readAll(at("far/a")), "new");
  EXPECT_EQ(fs::read_symlink(at("near")), "far/a");
  EXPECT_EQ(fs::read_symlink(at("link")), at("near"));
  EXPECT_FALSE(fs::exists(at("far/a.partial-1-2")));
  replaceBy(at("dangling"), "new");
  EXPECT_EQ(readAll(at("far/new")), "new");
  EXPECT_TRUE(fs::is_symlink(at("dangling")));
  EXPECT_EQ(fileCount(), 4u);
}

TEST_F(AtomicOutput, HardLinksKeepTheOldContent) {
  writeAll(at("a"), "old");
  fs::create_hard_link(at("a"), at("b"));
  replaceBy(at("a"), "new");
  EXPECT_EQ(readAll(at("a")) + readAll(at("b")), "newold");
}

TEST_F(AtomicOutput, TheModeStaysAndTheUmaskDecidesOfNewFiles) {
  const auto modeOf = [&](const fs::path& file) {
    struct stat info {};
    EXPECT_EQ(::stat(file.c_str(), &info), 0) << file;
    return info.st_mode & 07777;
  };
  for (const mode_t mode : {0600, 0640, 0666, 0755}) {
    writeAll(at("a"), "old");
    ASSERT_EQ(::chmod(at("a").c_str(), mode), 0);
    AtomicFile file(at("a"));
    for (const auto& entry : fs::directory_iterator(at(""))) {
      EXPECT_EQ(modeOf(entry.path()), mode) << entry.path();  // the partial file too
    }
    file.commit();
    EXPECT_EQ(modeOf(at("a")), mode);
  }
  const mode_t before = ::umask(027);
  replaceBy(at("b"), "new");
  ::umask(before);
  EXPECT_EQ(modeOf(at("b")), 0640u);
}

// One of these is a stream that leads to a regular file: a rename would detach it from the process
// that holds it open.
TEST_F(AtomicOutput, WhatIsNoFileIsRefusedAndStays) {
  writeAll(at("open"), "old");
  const int fd = ::open(at("open").c_str(), O_RDWR);
  fs::create_symlink("/dev/null", at("null"));
  fs::create_symlink("/proc/self/fd/" + std::to_string(fd), at("stream"));
  fs::create_symlink("loop", at("loop"));
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  for (const fs::path& output :
       {fs::path("/dev/null"), fs::path("/dev/stdout"), fs::path("/dev/fd/1"), at("null"),
        at("stream"), at("loop"), at("pipe"), at(""), at("absent/a")}) {
    EXPECT_THROW(AtomicFile{output}, OutputError) << output;
  }
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(readAll(at("open")), "old");
  EXPECT_EQ(fileCount(), 5u);
  ::close(fd);
}

}  // namespace
}  // namespace bnvpl
