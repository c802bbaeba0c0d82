// No run overwrites or removes a file that it reads, or writes two outputs to one file.
#include <map>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using std::string_literals::operator""s;

class Files : public PipelineTest {
 protected:
  void SetUp() override {
    fs::copy(BNVPL_SOURCE "/scenes/test", at("scene"), fs::copy_options::recursive);
    fs::create_directories(at("sub"));
    makeStages(toml_);
    succeed("vpl-render",
            toml_ + lit_ + " --spp 1 -o " + path("image.exr") + " --png " + path("image.png"));
  }
  // The content of every file and the target of every link.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> contents;
    for (const std::string& name : listing()) {
      if (fs::is_symlink(at(name)))
        contents[name] = "-> " + fs::read_symlink(at(name)).string();
      else if (fs::is_regular_file(at(name)))
        contents[name] = readAll(at(name));
    }
    return contents;
  }
  // Expects an error before anything is touched, in one line that holds every part.
  void refused(const std::string& name, const std::string& arguments,
               const std::vector<std::string>& parts, int code = kExitUsage) const {
    const auto before = everything();
    fail(name, arguments, code, parts);
    EXPECT_TRUE(everything() == before) << name << " " << arguments;
  }

  const std::string toml_ = path("scene/one-bounce.toml") + " ";
  const std::string candidates_ = path("candidates.vpl") + " ", vpls_ = path("vpls.vpl") + " ";
  const std::string lit_ = path("lit.vpl") + " ";
};

TEST_F(Files, OutputsThatAreInputs) {
  refused("vpl-place", toml_ + "-n 9 -o " + toml_, {"-o '", "scene '", "one-bounce.toml'"});
  refused("vpl-place", toml_ + "-n 9 -o " + path("x.vpl") + " --stats " + toml_,
          {"--stats", "scene '"});
  refused("vpl-eliminate", candidates_ + "-n 9 -o " + candidates_, {"-o", "candidates '"});
  refused("vpl-eliminate", candidates_ + "-n 9 -o " + path("x.vpl") + " --depfile " + candidates_,
          {"--depfile", "candidates '", "another file for --depfile"});
  refused("vpl-estimate", toml_ + vpls_ + "-o " + vpls_, {"-o", "vpls '"});
  const std::string render = toml_ + lit_ + "--spp 1 ";
  refused("vpl-render", render + "-o " + lit_, {"-o", "lit '"});
  refused("vpl-render", render + "-o " + path("x.exr") + " --png " + lit_, {"--png", "lit '"});
  refused("vpl-render", render + "-o " + path("x.exr") + " --png " + toml_, {"--png", "scene '"});
}

TEST_F(Files, OutputsOfInspectThatAreInputs) {
  const std::string image = path("image.exr"), both = "compare " + image + " " + image + " ";
  refused("vpl-inspect", "plot " + lit_ + "--scene " + toml_ + "-o " + lit_, {"-o", "file '"});
  refused("vpl-inspect", "plot " + lit_ + "--scene " + toml_ + "-o " + toml_, {"-o", "--scene '"});
  refused("vpl-inspect", "export " + lit_ + "-o " + path("x.ply") + " --stats " + lit_,
          {"--stats", "file '"});
  refused("vpl-inspect", both + "--diff " + image, {"--diff", "A '"});
  refused("vpl-inspect", "compare " + path("x.exr") + " " + image + " --diff " + image,
          {"--diff", "B '"});
  refused("vpl-inspect", both + "--mask " + path("image.png") + " --diff " + path("image.png"),
          {"--diff", "--mask '"});
  refused("vpl-inspect", both + "--second-half " + lit_ + " --diff " + lit_,
          {"--diff", "--second-half '"});
  refused("vpl-inspect", both + "--stats " + image, {"--stats", "A '"});
  refused("vpl-inspect", "info " + lit_ + "--stats " + lit_, {"--stats", "file '"});
  refused("vpl-inspect", "check " + vpls_ + lit_ + "--stats " + lit_, {"--stats", "file '"});
  refused("vpl-inspect", "check --quiet " + lit_ + "--scene " + toml_ + "--stats " + toml_,
          {"--stats", "--scene '"});
  succeed("vpl-inspect", both);  // two inputs may be equal
}

// Meshes, material libraries and textures are known only after the scene has been read.
TEST_F(Files, OutputsThatAreFilesOfTheScene) {
  const std::string obj = path("scene/one-bounce.obj"), mtl = path("scene/one-bounce.mtl");
  refused("vpl-place", toml_ + "-n 9 -o " + obj, {"-o", "one-bounce.obj"});
  fs::create_hard_link(at("scene/one-bounce.obj"), at("mesh.vpl"));
  fs::create_symlink("scene/one-bounce.mtl", at("library.exr"));
  refused("vpl-place", toml_ + "-n 9 -o " + path("mesh.vpl"), {"-o", "a mesh of the scene '"});
  refused("vpl-estimate", toml_ + vpls_ + "-o " + path("x.vpl") + " --depfile " + mtl,
          {"--depfile", "a material library of the scene '"});
  refused("vpl-estimate", toml_ + vpls_ + "-o " + path("x.vpl") + " --checkpoint " + obj,
          {"--checkpoint", "a mesh of the scene '"});
  refused("vpl-render", toml_ + lit_ + "--spp 1 -o " + path("library.exr"),
          {"-o", "a material library of the scene '"});
  refused("vpl-inspect",
          "plot " + lit_ + "--scene " + toml_ + "-o " + path("x.png") + " --depfile " + obj,
          {"--depfile", "a mesh of the scene '"});
  refused("vpl-inspect", "check " + lit_ + "--scene " + toml_ + "--stats " + obj,
          {"--stats", "a mesh of the scene '"});
  refused("vpl-place",
          copyVeachDoor() + " -n 9 -o " + path("x.vpl") + " --stats " +
              path("veach-door/landscape.png"),
          {"--stats", "an image of the scene '"});
}

TEST_F(Files, OtherSpellingsOfAnInput) {
  fs::create_symlink("lit.vpl", at("link.vpl"));
  fs::create_symlink("link.vpl", at("far.vpl"));
  fs::create_hard_link(at("lit.vpl"), at("hard.vpl"));
  fs::create_directory_symlink("sub", at("other"));
  for (const std::string same : {"link.vpl", "far.vpl", "hard.vpl", "./lit.vpl", "sub/../lit.vpl",
                                 "other/../lit.vpl", "sub//..//./lit.vpl"}) {
    refused("vpl-render", toml_ + lit_ + "--spp 1 -o " + path("x.exr") + " --stats " + path(same),
            {"--stats", "lit '", same});
    refused("vpl-render", toml_ + path(same) + " --spp 1 -o " + path("x.exr") + " --stats " + lit_,
            {"--stats", "lit '", same});
  }
}

TEST_F(Files, TwoOutputsOfOneName) {
  fs::create_symlink("new", at("dangling"));
  fs::create_hard_link(at("image.exr"), at("hard"));
  const std::string render = toml_ + lit_ + "--spp 1 -o ";
  for (const auto& [a, b] : std::map<std::string, std::string>{
           {"new", "new"}, {"./new", "sub/../new"}, {"dangling", "new"}, {"image.exr", "hard"}}) {
    for (const std::string option : {"--png", "--stats", "--depfile", "--checkpoint"}) {
      refused("vpl-render", render + path(a) + " " + option + " " + path(b),
              {"-o '", option, "a name of its own"});
    }
  }
  refused("vpl-place",
          toml_ + "-n 9 -o " + path("x.vpl") + " --stats " + path("y") + " --depfile " + path("y"),
          {"--stats", "--depfile"});
  refused("vpl-eliminate", candidates_ + "-n 9 -o " + path("x.vpl") + " --stats " + path("x.vpl"),
          {"-o", "--stats"});
  refused("vpl-inspect", "export " + lit_ + "-o " + path("x.ply") + " --stats " + path("x.ply"),
          {"-o", "--stats"});
  refused("vpl-inspect",
          "compare " + path("image.exr") + " " + path("image.exr") + " --diff " + path("x.png") +
              " --stats " + path("x.png"),
          {"--diff", "--stats"});
}

// The content of a file determines its kind, so a mistyped name destroys no file of another kind.
TEST_F(Files, AnOutputReplacesNoFileOfAnotherKind) {
  write("notes", "of somebody\n");
  write("package.json", "{\"name\": \"x\"}\n");
  write("Makefile", "all:\n\techo\n");
  fs::create_symlink("notes", at("link"));
  const std::string render = toml_ + lit_ + "--spp 1 -o ", image = path("image.exr");
  for (const char* name :
       {"candidates.vpl", "image.png", "notes", "link", "package.json", "Makefile"}) {
    refused("vpl-render", render + path("x.exr") + " --stats " + path(name),
            {name, "is not the JSON summary", "--stats", "name another file"}, kExitOutput);
    refused("vpl-render", render + path("x.exr") + " --depfile " + path(name),
            {name, "is not a list of files", "--depfile"}, kExitOutput);
  }
  for (const char* name : {"notes", "link", "image.png"}) {
    fs::copy(at(name), at(std::string("x") + name + ".exr"));
    refused("vpl-render", render + path(std::string("x") + name + ".exr"),
            {"is not an OpenEXR image", "-o"}, kExitOutput);
  }
  write("short.exr", "\x76\x2f\x31\x01\x02");  // as a full disk leaves it
  refused("vpl-render", render + path("short.exr"), {"is not an OpenEXR image"}, kExitOutput);
  fs::copy(at("image.exr"), at("wrong.vpl"));
  fs::copy(at("image.exr"), at("wrong.png"));
  fs::copy(at("lit.vpl"), at("wrong.csv"));
  fs::copy(at("lit.vpl"), at("wrong.ply"));
  fs::copy(at("image.png"), at("wrong.svg"));
  const std::string wrong = path("wrong.vpl"), png = path("wrong.png");
  refused("vpl-place", toml_ + "-n 9 -o " + wrong, {"is not VPLs"}, kExitOutput);
  refused("vpl-eliminate", candidates_ + "-n 9 -o " + wrong, {"is not VPLs"}, kExitOutput);
  refused("vpl-estimate", toml_ + vpls_ + "-o " + wrong, {"is not VPLs"}, kExitOutput);
  refused("vpl-render", render + path("x.exr") + " --png " + png, {"is not a PNG"}, kExitOutput);
  refused("vpl-inspect", "export " + lit_ + "-o " + path("wrong.csv"), {"a CSV"}, kExitOutput);
  refused("vpl-inspect", "export " + lit_ + "-o " + path("wrong.ply"), {"a PLY"}, kExitOutput);
  refused("vpl-inspect", "plot " + lit_ + "--scene " + toml_ + "-o " + png, {"PNG"}, kExitOutput);
  refused("vpl-inspect", "compare " + image + " " + image + " --diff " + png, {"a PNG"},
          kExitOutput);
  refused("vpl-inspect", "run " + path("sub") + " --svg " + path("wrong.svg"), {"an SVG"},
          kExitOutput);
  refused("vpl-inspect", "info " + lit_ + "--stats " + path("candidates.vpl"), {"JSON"},
          kExitOutput);
}

// Files of other programs in our formats are somebody's work, as VPLs of another stage are.
TEST_F(Files, AnOutputReplacesNoFileOfAnotherMaker) {
  const std::string exports = "export " + lit_ + "-o ", run = "run pipelines/slurm/example --svg ";
  write("mesh.ply",
        "ply\nformat ascii 1.0\ncomment my scanned bunny\nelement vertex 0\nend_header\n");
  write("late.ply", "ply\nformat ascii 1.0\nelement vertex 0\ncomment vpl-inspect, \nend_header\n");
  write("table.csv", "id,price\n1,2\n");
  write("drawing.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"><!-- by hand --></svg>\n");
  write("drawing2.svg", "<?xml version=\"1.0\"?>\n<svg/>\n");
  write("photo.png",
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0abcd"
        "\0\0\0\4gAMA\0\0\xb1\x8f"
        "abcd"s);
  write("sky.exr", "\x76\x2f\x31\x01\2\0\0\0channels\0chlist\0"s);
  for (const char* name : {"mesh.ply", "late.ply", "table.csv"})
    refused("vpl-inspect", exports + path(name), {name, "of vpl-inspect", "name another file"},
            kExitOutput);
  for (const char* name : {"drawing.svg", "drawing2.svg"})
    refused("vpl-inspect", run + path(name), {name, "SVG picture of vpl-inspect"}, kExitOutput);
  refused("vpl-inspect", "plot " + lit_ + "--scene " + toml_ + "-o " + path("photo.png"), {"PNG"},
          kExitOutput);
  const std::string render = toml_ + lit_ + "--spp 1 -o ";
  refused("vpl-render", render + path("x.exr") + " --png " + path("photo.png"), {"PNG"},
          kExitOutput);
  refused("vpl-render", render + path("sky.exr"), {"OpenEXR image of vpl-render"}, kExitOutput);
}

TEST_F(Files, VplsOfAnotherStageAreNotReplaced) {
  const std::string light = toml_ + "--method light -n 9 -o ", name = "name another file";
  refused("vpl-place", toml_ + "-n 9 -o " + lit_, {"is not VPLs of stage candidates", name},
          kExitOutput);
  refused("vpl-place", toml_ + "-n 9 -o " + vpls_, {"is not VPLs of stage candidates"},
          kExitOutput);
  refused("vpl-place", light + candidates_, {"is not VPLs of stage lit"}, kExitOutput);
  refused("vpl-eliminate", candidates_ + "-n 9 -o " + lit_, {"is not VPLs of stage eliminated"},
          kExitOutput);
  refused("vpl-estimate", toml_ + vpls_ + "-o " + candidates_, {"is not VPLs of stage lit"},
          kExitOutput);
  succeed("vpl-place", light + path("p.vpl") + " --quiet");
  succeed("vpl-place", light + path("p.vpl") + " --quiet");
  const std::string reject = "--method rejection -n 3 --quiet --scene " + toml_ + "-o ";
  succeed("vpl-eliminate", path("p.vpl") + " " + reject + path("r.vpl"));
  succeed("vpl-eliminate", path("p.vpl") + " " + reject + path("r.vpl"));
  succeed("vpl-place", toml_ + "-n 9 --shard 1/1 --quiet -o " + path("c.shard"));
  succeed("vpl-estimate", toml_ + vpls_ + "--photons 1k --shard 1/1 --quiet -o " + path("l.shard"));
  refused("vpl-place", toml_ + "-n 9 --shard 1/1 -o " + path("l.shard"), {"a shard of vpl-place"},
          kExitOutput);
  refused("vpl-merge", path("c.shard") + " -o " + path("l.shard"), {"a shard of vpl-place"},
          kExitOutput);
  refused("vpl-merge", path("c.shard") + " -o " + lit_, {"is not VPLs of stage candidates"},
          kExitOutput);
  refused("vpl-merge", path("l.shard") + " -o " + candidates_, {"is not VPLs of stage lit"},
          kExitOutput);
  for (int time = 0; time < 2; ++time) {
    succeed("vpl-merge", path("c.shard") + " --quiet -o " + path("few.shard"));
    succeed("vpl-merge", path("c.shard") + " --quiet -o " + path("m.vpl"));
  }
}

TEST_F(Files, AnOlderFileOfTheKindIsReplaced) {
  write("empty", "");
  fs::copy(at("empty"), at("empty.vpl"));
  succeed("vpl-place",
          toml_ + "-n 9 --quiet -o " + path("empty.vpl") + " --stats " + path("empty"));
  const std::string image = path("image.exr");
  for (int time = 0; time < 2; ++time) {
    succeed("vpl-render", toml_ + lit_ + "--spp 1 --quiet -o " + image + " --png " +
                              path("image.png") + " --stats " + path("s") + " --depfile " +
                              path("d"));
    succeed("vpl-inspect", "--quiet export " + lit_ + "-o " + path("x.csv"));
    succeed("vpl-inspect", "--quiet export " + lit_ + "-o " + path("x.PLY"));
    EXPECT_EQ(tool("vpl-inspect", "run pipelines/slurm/example --svg " + path("x.svg")).code, 0);
    succeed("vpl-estimate",
            toml_ + vpls_ + "--photons 1k --quiet --shard 1/1 -o " + path("x.shard"));
  }
}

TEST_F(Files, MergeKeepsWhatTheShardsWereMadeFrom) {
  succeed("vpl-estimate",
          toml_ + vpls_ + "--photons 50k --quiet --shard 1/1 -o " + path("x.shard"));
  refused("vpl-merge", path("x.shard") + " -o " + vpls_, {"vpls.vpl", "is not VPLs of stage lit"},
          kExitOutput);
}

TEST_F(Files, ACheckpointIsNoOtherFile) {
  const std::string estimate = toml_ + vpls_ + "--photons 1k -o " + path("new.vpl");
  refused("vpl-estimate", estimate + " --checkpoint " + path("new.vpl"), {"-o", "--checkpoint"});
  refused("vpl-estimate", estimate + " --checkpoint " + vpls_, {"vpls '", "--checkpoint"});
  refused("vpl-estimate", estimate + " --checkpoint " + toml_, {"scene '", "--checkpoint"});
  refused("vpl-render",
          toml_ + lit_ + "--spp 1 -o " + path("image.exr") + " --checkpoint " + path("image.exr"),
          {"-o", "--checkpoint"});
}

// Such a file is removed neither at the start nor at the end of the work.
TEST_F(Files, WhatIsNoCheckpointIsNeverRemoved) {
  write("notes", "of somebody");
  write("empty", "");
  for (const char* name : {"notes", "empty", "candidates.vpl", "image.png"}) {
    refused("vpl-estimate",
            toml_ + vpls_ + "--photons 1k -o " + path("x.vpl") + " --checkpoint " + path(name),
            {name, "is no checkpoint", "name another file"}, kExitInput);
    refused("vpl-render",
            toml_ + lit_ + "--spp 1 -o " + path("x.exr") + " --checkpoint " + path(name),
            {name, "is no checkpoint"}, kExitInput);
  }
}

// A checkpoint through a link is written and removed at the link's target; the link stays.
TEST_F(Files, ACheckpointMayBeALink) {
  fs::create_symlink("sub/real", at("work"));
  const std::string estimate =
      toml_ + vpls_ + "--quiet -o " + path("x.vpl") + " --checkpoint " + path("work");
  interrupt("vpl-estimate", estimate + " --photons 1G", "sub/real");
  EXPECT_TRUE(fs::is_symlink(at("work")));
  fs::remove(at("sub/real"));
  succeed("vpl-estimate", estimate + " --photons 100k --checkpoint-every 0");
  EXPECT_TRUE(fs::is_symlink(at("work")));
  EXPECT_FALSE(fs::exists(at("sub/real")));
}

// Files beside an output that are named like its unfinished versions are removed.
TEST_F(Files, InputsNamedAsUnfinishedOutputs) {
  fs::copy(at("candidates.vpl"), at("v.vpl.partial-12-3"));
  refused("vpl-eliminate", path("v.vpl.partial-12-3") + " -n 9 -o " + path("v.vpl"),
          {"candidates '", "-o '", "rename it"});
  succeed("vpl-eliminate", path("v.vpl.partial-12-3") + " -n 9 -o " + path("w.vpl"));
}

}  // namespace
}  // namespace bnvpl
