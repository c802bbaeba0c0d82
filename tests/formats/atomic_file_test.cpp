// Output that is whole or absent, and what killed runs left beside it.
#include "formats/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>

#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

using AtomicOutput = TestFolder;

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
  writeFileAtomically(at("a"), "new");
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
  writeFileAtomically(at("a"), "new");
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

}  // namespace
}  // namespace bnvpl
