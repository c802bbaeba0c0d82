// The Makefile and the ninja file rerun a stage only when its own inputs or options change.
#include <unistd.h>

#include <map>
#include <regex>
#include <sstream>

#include "tests/pipeline/tool_runner.h"

namespace bnvpl {
namespace {

class Rerun : public PipelineTest {
 protected:
  void SetUp() override { copyVeachDoor(); }

  // Runs Make and returns the stages whose commands it printed, such as "place eliminate ".
  std::string made(const std::string& more = "") const {
    const Outcome r =
        shell("make -f pipelines/Makefile SCENE=" + path("veach-door/scene.toml") +
              " OUT=" + path("out") +
              " BIN=" BNVPL_BIN_FROM_SOURCE " CANDIDATES=2k VPLS=200 PHOTONS=20k SPP=1 " + more);
    EXPECT_EQ(r.code, 0) << r.out << r.err;
    return stagesIn(r.out, "/vpl-", " ");
  }
  bool upToDate(const std::string& more = "") const { return made("-n " + more).empty(); }

  bool haveNinja() const { return shell("ninja --version").code == 0; }
  void generate(const std::string& photons) const {
    const Outcome r = shell(
        "pipelines/generate_ninja.py " + path("veach-door/scene.toml") + " --out " + path("n") +
        " --bin " BNVPL_BIN_FROM_SOURCE " --candidates 2k --vpls 200 --spp 1 --photons " + photons);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  std::string built() const {
    const Outcome r = shell("ninja -v -f " + path("n/build.ninja"));
    EXPECT_EQ(r.code, 0) << r.out << r.err;
    return stagesIn(r.out, "/vpl-", " ");
  }
  // Sets a time later than everything made so far, even on a file system with coarse times.
  void touch(const std::string& name) const {
    ::usleep(20000);
    fs::last_write_time(at(name), fs::file_time_type::clock::now());
  }

  static std::string stagesIn(const std::string& log, const std::string& before,
                              const std::string& after) {
    std::string stages;
    for (const std::string name : {"place", "eliminate", "estimate", "render"}) {
      if (contains(log, before + name + after)) stages += (stages.empty() ? "" : " ") + name;
    }
    return stages;
  }
  const std::string all_ = "place eliminate estimate render";
};

TEST_F(Rerun, MakeRunsWhatChanged) {
  EXPECT_FALSE(upToDate());
  EXPECT_EQ(made(), all_);
  for (const char* file : {"candidates.vpl", "vpls.vpl", "lit.vpl", "image.exr", "image.png"}) {
    EXPECT_TRUE(fs::exists(at("out") / file)) << file;
  }
  EXPECT_EQ(made(), "");
  EXPECT_TRUE(upToDate());
  touch("veach-door/landscape.png");
  EXPECT_FALSE(upToDate());
  EXPECT_EQ(made(), all_);
  EXPECT_EQ(made(), "");
  EXPECT_EQ(made("PHOTONS=30k"), "estimate render");
  EXPECT_EQ(made("PHOTONS=30k"), "");
  EXPECT_EQ(made("PHOTONS=30k SPP=2"), "render");
  EXPECT_EQ(made("PHOTONS=30k SPP=2 VPLS=150"), "eliminate estimate render");
  EXPECT_EQ(made("PHOTONS=30k SPP=2 VPLS=150 RUN_FLAGS=--quiet"), "");
}

TEST_F(Rerun, MakeFollowsEveryFileOfTheScene) {
  EXPECT_EQ(made("-j4"), all_);
  for (const char* file :
       {"veach-door/scene.toml", "veach-door/room.mtl", "teapot/teapot.obj", "teapot/glossy.mtl"}) {
    touch(file);
    EXPECT_FALSE(upToDate()) << file;
    EXPECT_EQ(made(), all_) << file;
  }
  fs::remove(at("out/lit.vpl"));
  EXPECT_EQ(made(), "estimate render");
  fs::remove(at("out/image.png"));
  EXPECT_EQ(made(), "render");
  EXPECT_EQ(made(), "");
}

// This holds even if the file keeps its old time, as with mv, and if its name holds spaces.
TEST_F(Rerun, AMissingTextureIsSeenWhenItArrives) {
  const fs::path texture = at("veach-door/wood (1) floor.png"), away = at("away.png");
  fs::rename(at("veach-door/landscape.png"), away);
  const std::string mtl = readAll(at("veach-door/room.mtl"));
  write("veach-door/room.mtl",
        std::regex_replace(mtl, std::regex("landscape\\.png"), "wood (1) floor.png"));
  const auto follows = [&](const auto& build) {
    EXPECT_EQ(build(), all_);
    EXPECT_EQ(build(), "");
    for (int twice = 0; twice < 2; ++twice) {
      ::usleep(20000);
      fs::rename(away, texture);
      EXPECT_EQ(build(), all_);
      EXPECT_EQ(build(), "");
      ::usleep(20000);
      fs::rename(texture, away);
      EXPECT_EQ(build(), all_);
      EXPECT_EQ(build(), "");
    }
  };
  follows([&] { return made(); });
  if (!haveNinja()) return;
  generate("20k");
  follows([&] { return built(); });
}

TEST_F(Rerun, NamesThatMakeOrNinjaMisreadAreRefusedAtOnce) {
  for (const char* name : {"a&b", "a;b", "a`b", "a%b", "a*b", "a=b", "a:b", "a(b", "a#b", "a^b"}) {
    const std::string scene = path(std::string(name) + "/scene.toml");
    for (const std::string& command :
         {"make -f pipelines/Makefile OUT=" + path("o") + " SCENE=" + scene,
          "pipelines/generate_ninja.py --out " + path("o") + " " + scene}) {
      const Outcome r = shell(command);
      EXPECT_NE(r.code, 0);
      EXPECT_TRUE(contains(r.err, "which the pipelines cannot handle; choose")) << name << r.err;
    }
  }
  EXPECT_FALSE(fs::exists(at("o")));
  const std::string mtl = readAll(at("veach-door/room.mtl"));
  for (const char* name : {"a;b.png", "a=b.png", "a$b.png", "a*b.png", "a:b.png"}) {
    fs::copy_file(at("veach-door/landscape.png"), at(std::string("veach-door/") + name));
    std::string edited = mtl;
    write("veach-door/room.mtl", edited.replace(mtl.find("landscape.png"), 13, name));
    fail("vpl-place",
         path("veach-door/scene.toml") + " --quiet -n 1k -o " + path("c.vpl") + " --depfile " +
             path("c.d"),
         3, {"--depfile: Make and ninja cannot read the name", "rename it"});
  }
  write("veach-door/room.mtl", mtl);
  fail("vpl-place",
       path("veach-door/scene.toml") + " --quiet -n 1k -o " + path("c*.vpl") + " --depfile " +
           path("c.d"),
       2, {"--depfile: Make and ninja cannot read the name", "rename it"});
  // A depfile names the folder of a missing file by its absolute path.
  fs::copy(at("veach-door"), at("b:c"));
  fs::remove(at("b:c/landscape.png"));
  const Outcome r =
      shell("sh -c 'cd \"$0\" && \"$1\" scene.toml --quiet -n 1k -o c.vpl --depfile c.d' " +
            path("b:c") + " '" BNVPL_BIN "/vpl-place'");
  EXPECT_EQ(r.code, 3) << r.err;
  EXPECT_TRUE(contains(r.err, "--depfile: Make and ninja cannot read the name")) << r.err;
  EXPECT_FALSE(fs::exists(at("c.vpl")) || fs::exists(at("b:c/c.vpl")));
}

// This also holds where the output folder contains files of others.
TEST_F(Rerun, CleanRemovesWhatMakeMade) {
  const std::vector<std::string> others{"package.json", "notes.d",        "run.cmd", "image.png",
                                        "x.checkpoint", "shards/a.shard", "place.d"};
  fs::create_directories(at("out/shards"));
  for (const std::string& name : others) write("out/" + name, "# of somebody\n");
  const auto clean = [&] { return made("clean"), listing(); };
  const auto before = listing();
  EXPECT_EQ(clean(), before);
  for (const char* name : {"out/image.png", "out/place.d"}) fs::remove(at(name));
  const auto unmade = listing();
  made("SHARDS=place=2");
  made();
  EXPECT_NE(listing(), unmade);
  EXPECT_EQ(clean(), unmade);
}

TEST_F(Rerun, NinjasGraphReplacesNoOther) {
  write("build.ninja", "# of CMake\n");
  const Outcome r = shell("pipelines/generate_ninja.py " + path("veach-door/scene.toml") +
                          " --bin " BNVPL_BIN_FROM_SOURCE " --out " + path(""));
  EXPECT_EQ(r.code, 1);
  EXPECT_TRUE(contains(r.err, "is not a graph of this program")) << r.err;
  EXPECT_EQ(readAll(at("build.ninja")), "# of CMake\n");
}

TEST_F(Rerun, MakeStopsAtAFailureAndKeepsTheOldFiles) {
  EXPECT_EQ(made(), all_);
  const std::string image = readAll(at("out/image.exr"));
  const Outcome r = shell("make -f pipelines/Makefile SCENE=" + path("veach-door/scene.toml") +
                          " OUT=" + path("out") +
                          " BIN=" BNVPL_BIN_FROM_SOURCE " CANDIDATES=2k VPLS=3k PHOTONS=20k SPP=1");
  EXPECT_NE(r.code, 0);
  EXPECT_TRUE(contains(r.err, "vpl-eliminate: ")) << r.err;
  EXPECT_EQ(readAll(at("out/image.exr")), image);
  EXPECT_EQ(made("VPLS=100"), "eliminate estimate render");
}

// This holds for the failing or interrupted stage itself and its preview. The stage runs again,
// with other options or the same.
TEST_F(Rerun, AFailedRenderLeavesTheGoodImageAndPreview) {
  EXPECT_EQ(made(), all_);
  const std::string image = readAll(at("out/image.exr")), preview = readAll(at("out/image.png"));
  const auto kept = [&] {
    return fs::exists(at("out/image.exr")) && fs::exists(at("out/image.png")) &&
           readAll(at("out/image.exr")) == image && readAll(at("out/image.png")) == preview;
  };
  const std::string make = "make -f pipelines/Makefile SCENE=" + path("veach-door/scene.toml") +
                           " OUT=" + path("out") +
                           " BIN=" BNVPL_BIN_FROM_SOURCE " CANDIDATES=2k VPLS=200 PHOTONS=20k SPP=";
  for (const std::string bad : {"1 RENDER_FLAGS='--size 0x0'", "1 RENDER_FLAGS='--clamp -1'"}) {
    for (int twice = 0; twice < 2; ++twice) {
      const Outcome r = shell(make + bad);
      EXPECT_NE(r.code, 0);
      EXPECT_TRUE(contains(r.err, "vpl-render: ")) << r.err;
      EXPECT_TRUE(kept()) << bad << r.err;
    }
  }
  EXPECT_NE(shell("timeout -s INT 3 " + make + "10M").code, 0);  // far from its end
  EXPECT_TRUE(kept());
  EXPECT_EQ(made(), "render");
  EXPECT_EQ(made(), "");
  EXPECT_TRUE(kept());  // identical bytes
}

TEST_F(Rerun, NinjaLeavesTheGoodImageAndPreviewOfAFailedRender) {
  if (!haveNinja()) GTEST_SKIP() << "ninja is not installed";
  generate("20k");
  EXPECT_EQ(built(), all_);
  const std::string image = readAll(at("n/veach-door/image.exr")),
                    preview = readAll(at("n/veach-door/image.png"));
  generate("20k --render-flags='--size 0x0'");
  for (int twice = 0; twice < 2; ++twice) {
    const Outcome r = shell("ninja -f " + path("n/build.ninja"));
    EXPECT_NE(r.code, 0);
    EXPECT_TRUE(contains(r.out + r.err, "vpl-render: ")) << r.out << r.err;
    EXPECT_TRUE(readAll(at("n/veach-door/image.exr")) == image);
    EXPECT_TRUE(readAll(at("n/veach-door/image.png")) == preview);
  }
  generate("20k --render-flags='--seed 2'");
  EXPECT_EQ(built(), "render");
}

TEST_F(Rerun, NinjaRunsWhatChanged) {
  if (!haveNinja()) GTEST_SKIP() << "ninja is not installed";
  generate("20k");
  EXPECT_EQ(built(), all_);
  EXPECT_EQ(built(), "");
  generate("20k");
  EXPECT_EQ(built(), "");
  touch("veach-door/landscape.png");
  EXPECT_EQ(built(), all_);
  generate("30k");
  EXPECT_EQ(built(), "estimate render");
  EXPECT_EQ(built(), "");
}

// Make and ninja both take their presets from quality.mk alone.
TEST_F(Rerun, QualitiesAreThoseOfOneFile) {
  std::map<std::string, std::map<std::string, std::string>> presets;
  std::istringstream lines(readAll(BNVPL_SOURCE "/pipelines/quality.mk"));
  std::smatch m;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, m, std::regex(R"((\w+)\.(\w+)\s*:=\s*(.*))")))
      presets[m[2]][m[1]] = m[3];
  }
  ASSERT_EQ(presets.size(), 4u);
  for (auto& [quality, of] : presets) {
    const Outcome make =
        shell("make -n -f pipelines/Makefile SCENE=" + path("veach-door/scene.toml") +
              " OUT=" + path("q") + " BIN=" BNVPL_BIN_FROM_SOURCE " QUALITY=" + quality);
    const Outcome ninja =
        shell("pipelines/generate_ninja.py " + path("veach-door/scene.toml") + " --out " +
              path("q") + " --bin " BNVPL_BIN_FROM_SOURCE " --quality " + quality);
    EXPECT_EQ(make.code + ninja.code, 0) << make.err << ninja.err;
    const auto behind = [&counts = of](const char* stage) {
      return counts[stage].empty() ? "" : " " + counts[stage];
    };
    for (const std::string& text : {make.out, readAll(at("q/build.ninja"))}) {
      for (const std::string& part :
           {"candidates.vpl -n " + of["CANDIDATES"] + " ", "vpls.vpl -n " + of["VPLS"] + " ",
            " --photons " + of["PHOTONS"] + " ", " --spp " + of["SPP"] + " ",
            of["PHOTONS"] + behind("ESTIMATE") + " --", behind("RENDER") + " --"}) {
        EXPECT_TRUE(contains(text, part)) << quality << ": " << part << "\n" << text;
      }
    }
  }
  const Outcome wrong = shell("make -n -f pipelines/Makefile QUALITY=best");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(contains(wrong.err, "QUALITY='best'")) << wrong.err;
}

// Both make the same image.
TEST_F(Rerun, MakeAndNinjaAgree) {
  if (!haveNinja()) GTEST_SKIP() << "ninja is not installed";
  generate("20k");
  EXPECT_EQ(built(), all_);
  EXPECT_EQ(made(), all_);
  EXPECT_TRUE(readAll(at("out/image.exr")) == readAll(at("n/veach-door/image.exr")));
}

// Shards with a launcher give the same files and continue where they were stopped.
TEST_F(Rerun, ShardsMakeTheSameFilesAndRunAgainWhereSomethingChanged) {
  if (!haveNinja()) GTEST_SKIP() << "ninja is not installed";
  generate("20k");
  built();
  const std::string whole = readAll(at("n/veach-door/image.exr"));
  const std::string preview = readAll(at("n/veach-door/image.png"));
  generate("20k --shards 3 --launcher 'env LAUNCHED=1'");
  const Outcome first = shell("ninja -v -j 2 -f " + path("n/build.ninja"));
  EXPECT_EQ(first.code, 0) << first.out << first.err;
  EXPECT_TRUE(contains(first.out, "env LAUNCHED=1"));
  EXPECT_TRUE(readAll(at("n/veach-door/image.exr")) == whole);
  EXPECT_TRUE(readAll(at("n/veach-door/image.png")) == preview);
  EXPECT_TRUE(contains(shell("ninja -f " + path("n/build.ninja")).out, "no work to do"));
  fs::remove(at("n/veach-door/shards/render-2-of-3.shard"));
  const Outcome again = shell("ninja -v -f " + path("n/build.ninja"));
  EXPECT_EQ(stagesIn(again.out, "/vpl-", " "), "render") << again.out;
  EXPECT_FALSE(contains(again.out, "--shard 1/3"));
  EXPECT_TRUE(readAll(at("n/veach-door/image.exr")) == whole);
}

}  // namespace
}  // namespace bnvpl
