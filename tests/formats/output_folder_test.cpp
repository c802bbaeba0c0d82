// A folder of outputs is whole or absent, and never replaces files that others put there.
#include "formats/output_folder.h"

#include <sys/wait.h>

#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

class OutputFolderTest : public TestFolder {
 protected:
  static void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string get(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void make(const std::string& text) const {
    OutputFolder folder(at("made"));
    put(folder.add("a.txt"), text);
    put(folder.add("sub/b.txt"), text);
    EXPECT_NE(get(at("made/a.txt")), text);
    folder.commit();
  }
};

TEST_F(OutputFolderTest, StandsThereWholeAndIsReplacedWhole) {
  make("one");
  EXPECT_EQ(get(at("made/sub/b.txt")), "one");
  put(at("made/extra"), "");
  EXPECT_THROW(make("two"), OutputError);
  fs::remove(at("made/extra"));
  fs::remove(at("made/a.txt"));  // replacing the rest loses nothing
  make("two");
  EXPECT_EQ(get(at("made/a.txt")), "two");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(OutputFolderTest, WithoutCommitNothingIsThere) {
  {
    OutputFolder folder(at("made"));
    put(folder.add("sub/b.txt"), "one");
    EXPECT_EQ(fileCount(), 1u);
  }
  EXPECT_EQ(fileCount(), 0u);
}

// Each run removes partial folders that no process holds; none may take one that just begins.
TEST_F(OutputFolderTest, RunsThatBeginTogetherLeaveEachOthersFolders) {
  std::vector<pid_t> runs;
  for (int run = 0; run < 3; ++run) {
    runs.push_back(::fork());
    if (runs.back() != 0) continue;
    try {
      for (int i = 0; i < 400; ++i) {
        OutputFolder folder(at("made"));
        std::ofstream file(folder.add("a.txt"));
        if (!file) ::_exit(2);
      }
    } catch (const OutputError&) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  for (const pid_t run : runs) {
    int status = -1;
    ASSERT_EQ(::waitpid(run, &status, 0), run);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(OutputFolderTest, AFileThatAppearsMeanwhileStays) {
  make("one");
  OutputFolder folder(at("made"));
  put(folder.add("a.txt"), "two");
  put(at("made/late"), "precious");
  EXPECT_THROW(folder.commit(), OutputError);
  EXPECT_EQ(get(at("made/late")), "precious");
  EXPECT_EQ(get(at("made/a.txt")), "one");
}

TEST_F(OutputFolderTest, LinksAndChangedFilesAreOthers) {
  make("one");
  fs::rename(at("made/a.txt"), at("elsewhere"));
  fs::create_symlink(at("elsewhere"), at("made/a.txt"));  // a link to the same content
  EXPECT_THROW(make("two"), OutputError);
  fs::remove(at("made/a.txt"));
  put(at("made/a.txt"), "mine");
  EXPECT_THROW(make("two"), OutputError);
  EXPECT_EQ(get(at("made/a.txt")), "mine");
}

// Runs `fn` in its own process, which ends as if it were killed.
template <typename Fn>
void inProcess(const Fn& fn) {
  const pid_t child = ::fork();
  if (child == 0) {
    fn();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
}

TEST_F(OutputFolderTest, TheNextRunRemovesWhatAKilledOneLeft) {
  inProcess([&] {
    auto* folder = new OutputFolder(at("made"));
    put(folder->add("sub/b.txt"), "one");
  });
  EXPECT_EQ(fileCount(), 1u);
  make("two");
  EXPECT_EQ(fileCount(), 1u);
  OutputFolder open(at("other"));  // belongs to a process that is alive
  make("three");
  EXPECT_TRUE(fs::exists(open.partial()));
}

TEST_F(OutputFolderTest, ASignalHandlerRemovesIt) {
  inProcess([&] {
    auto* folder = new OutputFolder(at("made"));
    put(folder->add("sub/b.txt"), "one");
    folder->add("not yet written");
    removePartialFolder();
  });
  EXPECT_EQ(fileCount(), 0u);
}

}  // namespace
}  // namespace bnvpl
