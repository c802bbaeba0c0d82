// vpl-inspect scene --to-toml replaces only folders that it has made.
#include "tests/inspect/scene/to_toml.h"

namespace bnvpl {
namespace {

class ToTomlFolder : public ToToml {
 protected:
  void refuses(const Outcome& outcome, int code, const std::string& part) {
    EXPECT_EQ(outcome.code, code) << outcome.output;
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output;
    for (const auto& entry : fs::directory_iterator(at(".")))
      EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
  }
};

TEST_F(ToTomlFolder, OneThatItMadeIsReplaced) {
  writeTinyAs("scene.toml");
  fs::create_directory(at("copy"));  // empty
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  writeAll(at("tiny.mtl"), "newmtl white\nKd 0.2 0.2 0.2\n");
  const Outcome again = convert("scene.toml", "copy/");
  ASSERT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(loadScene(at("copy/scene.toml")).materials.at(0).phong().diffuse, Vec3(0.2f));
  refuses(again, 0, "");
}

TEST_F(ToTomlFolder, WithOthersFilesIsRefused) {
  writeTinyAs("scene.toml");
  fs::create_directories(at("mine/textures"));
  writeAll(at("mine/textures/0.png"), "precious");
  refuses(convert("scene.toml", "mine"), 4, "textures/0.png");
  EXPECT_EQ(readAll(at("mine/textures/0.png")), "precious");
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  writeAll(at("copy/notes.txt"), "precious");
  refuses(convert("scene.toml", "copy"), 4, "notes.txt");
  fs::remove(at("copy/notes.txt"));
  writeAll(at("copy/scene.mtl"), "newmtl mine\n");
  refuses(convert("scene.toml", "copy"), 4, "scene.mtl, which was changed");
  EXPECT_EQ(readAll(at("copy/scene.mtl")), "newmtl mine\n");
}

TEST_F(ToTomlFolder, WithTheScenesOwnFilesIsRefused) {
  writeTinyAs("scene.toml");
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  const std::string before = readAll(at("copy/scene.toml"));
  refuses(convert("copy/scene.toml", "copy"), 2, "which the run reads");
  writeAll(at("uses.toml"), kView + "[[mesh]]\nfile = \"copy/scene.obj\"\n");
  refuses(convert("uses.toml", "copy"), 2, "which the run reads");
  refuses(convert("scene.toml", "copy", "--stats " + quoted(at("copy/stats.json"))), 2,
          "another output");
  EXPECT_EQ(readAll(at("copy/scene.toml")), before);
  fs::create_directory_symlink(at("copy"), at("link"));
  refuses(convert("copy/scene.toml", "link"), 2, "which the run reads");
  EXPECT_EQ(convert("scene.toml", "link").code, 0);
  EXPECT_TRUE(fs::is_symlink(at("link")));
}

TEST_F(ToTomlFolder, ThatCannotBeOneIsRefused) {
  writeTinyAs("scene.toml");
  writeAll(at("file"), "precious");
  refuses(convert("scene.toml", "file"), 4, "is no folder");
  EXPECT_EQ(readAll(at("file")), "precious");
  refuses(convert("scene.toml", "none/copy"), 4, "cannot write");
}

TEST_F(ToTomlFolder, ThatIsTheCurrentOneIsRefused) {
  writeTinyAs("scene.toml");
  fs::create_directory(at("here"));
  Outcome outcome;
  outcome.code = std::system(
      ("cd " + quoted(at("here")) + " && '" BNVPL_INSPECT "' scene ../scene.toml --to-toml . 2>err")
          .c_str());
  EXPECT_NE(readAll(at("here/err")).find("name a folder"), std::string::npos);
  EXPECT_NE(outcome.code, 0);
}

}  // namespace
}  // namespace bnvpl
