// Allowed names of outputs, and what happens where a link, a device or an old file exists.
#include <sys/stat.h>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using Targets = PipelineTest;

// A tool with its arguments and the option whose value follows them.
struct Writer {
  std::string tool, arguments, option;
};

TEST_F(Targets, ExtensionsOfSomethingElseAreRefused) {
  makeStages(scene_);
  const std::string lit = path("lit.vpl");
  succeed("vpl-render", scene_ + " " + lit + " --spp 1 -o " + path("i.exr"));
  const std::string image = path("i.exr"), before = readAll(at("i.exr"));
  const std::vector<std::string> files = listing();
  const auto refused = [&](const Writer& w, const std::string& name, const std::string& cure) {
    const std::string contents = cure.ends_with(".vpl")   ? "VPLs"
                                 : cure.ends_with(".exr") ? "an OpenEXR image"
                                                          : "a PNG picture";
    fail(w.tool, w.arguments + " " + w.option + " " + path(name), kExitUsage,
         {w.option + " '", name, contents, "name it " + cure});
  };
  const Writer vpls[] = {{"vpl-place", scene_ + " -n 9", "-o"},
                         {"vpl-eliminate", path("candidates.vpl") + " -n 9", "-o"},
                         {"vpl-estimate", scene_ + " " + path("vpls.vpl"), "-o"}};
  for (const Writer& w : vpls) {
    refused(w, "x.exr", "x.vpl");
    refused(w, "x.v2", "x.vpl");
  }
  const std::string render = scene_ + " " + lit + " --spp 1";
  refused({"vpl-render", render, "-o"}, "x.png", "x.exr");
  refused({"vpl-render", render, "-o"}, "x.jpg", "x.exr");
  refused({"vpl-render", render + " -o " + path("y.exr"), "--png"}, "y.exr.jpg", "y.exr.png");
  refused({"vpl-render", render + " -o " + path("y.exr"), "--png"}, "z.exr", "z.png");
  refused({"vpl-inspect", "plot " + lit + " --scene " + scene_, "-o"}, "d.jpg", "d.png");
  refused({"vpl-inspect", "compare " + image + " " + image, "--diff"}, "d.exr", "d.png");
  fail("vpl-inspect", "export " + lit + " -o " + path("a.stl"), kExitUsage, {".ply or .csv"});
  EXPECT_EQ(listing(), files);
  EXPECT_EQ(readAll(at("i.exr")), before);
}

TEST_F(Targets, UpperCaseAndNoExtension) {
  succeed("vpl-place", scene_ + " -n 9 -o " + path("c.VPL"));
  succeed("vpl-place", scene_ + " -n 9 -o " + path("c"));
  EXPECT_EQ(readAll(at("c")), readAll(at("c.VPL")));
  succeed("vpl-render",
          scene_ + " --integrator path --spp 1 -o " + path("i.Exr") + " --png " + path("p.PNG"));
}

TEST_F(Targets, LinksStayAndModesToo) {
  fs::create_directories(at("data"));
  fs::create_symlink("data/i.exr", at("i.exr"));
  fs::create_symlink("data/p.png", at("p.png"));
  const std::string render = scene_ + " --integrator path --spp 1 -o " + path("i.exr") + " --png " +
                             path("p.png") + " --stats " + path("s.json");
  const auto modeOf = [&](const std::string& name) {
    struct stat info {};
    EXPECT_EQ(::stat(at(name).c_str(), &info), 0) << name;
    return info.st_mode & 07777;
  };
  EXPECT_EQ(tool("vpl-render", render, "umask 027;").code, kExitOk);
  EXPECT_EQ(modeOf("data/i.exr"), 0640u);
  EXPECT_EQ(modeOf("s.json"), 0640u);
  const std::string bytes = readAll(at("data/i.exr"));
  write("data/i.exr", "");
  ASSERT_EQ(::chmod(at("data/i.exr").c_str(), 0600), 0);
  ASSERT_EQ(::chmod(at("data/p.png").c_str(), 0666), 0);
  succeed("vpl-render", render);
  EXPECT_EQ(readAll(at("data/i.exr")), bytes);
  EXPECT_EQ(modeOf("data/i.exr"), 0600u);
  EXPECT_EQ(modeOf("data/p.png"), 0666u);
  EXPECT_TRUE(fs::is_symlink(at("i.exr")) && fs::is_symlink(at("p.png")));
  EXPECT_EQ(listing(), (std::vector<std::string>{"data", "data/i.exr", "data/p.png", "i.exr",
                                                 "p.png", "s.json"}));
}

// This includes a stdout that is a regular file held open by another process.
TEST_F(Targets, DevicesAndStreamsAreRefused) {
  const std::string place = scene_ + " -n 9 -o ", file = place + path("c.vpl") + " --stats ";
  fail("vpl-place", place + "/dev/null", kExitOutput, {"/dev/null: is a device", "name a file"});
  fail("vpl-place", file + "/dev/null", kExitOutput, {"/dev/null: is a device"});
  for (const char* stream : {"/dev/stdout", "/dev/stderr", "/dev/fd/1", "/proc/self/fd/1"}) {
    fail("vpl-place", place + stream, kExitOutput,
         {std::string(stream) + ": is an open stream", "name a file"});
    fail("vpl-place", file + stream, kExitOutput, {"open stream"});
  }
  fail("vpl-place", place + "-", kExitOutput, {"-: means standard output", "name a file"});
  fail("vpl-inspect", "info " + path("c.vpl") + " --stats /dev/stdout", kExitOutput, {"stream"});
  EXPECT_TRUE(listing().empty());
  EXPECT_TRUE(fs::is_symlink("/dev/stdout") && fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace bnvpl
