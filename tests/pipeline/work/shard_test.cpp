// --shard and vpl-merge: stages whose work is done in parts.
#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>

#include "formats/shard/shard_file.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class ShardRun : public PipelineTest {
 protected:
  // Makes the shards I/N of a command as I.shard; returns their names, last first.
  std::string makeShards(const std::string& name, const std::string& arguments, int of) const {
    std::string all;
    for (int i = 1; i <= of; ++i) {
      const std::string file = path(std::to_string(i) + ".shard");
      succeed(name, arguments + " --shard " + std::to_string(i) + "/" + std::to_string(of) +
                        " --quiet -o " + file);
      all = file + " " + all;
    }
    return all;
  }
  // The command in this many shards gives the bytes of `whole`.
  void expectTheSame(const std::string& name, const std::string& arguments, int of,
                     const std::string& whole) const {
    const std::string merged = "merged-" + whole;
    succeed("vpl-merge", makeShards(name, arguments, of) + "--quiet -o " + path(merged));
    EXPECT_EQ(readAll(at(merged)), readAll(at(whole))) << name << arguments << " in " << of;
  }
  void expectTheSameInParts(const std::string& name, const std::string& arguments,
                            const std::string& whole, const std::vector<int>& counts) const {
    succeed(name, arguments + " --quiet -o " + path(whole));
    for (const int of : counts) expectTheSame(name, arguments, of, whole);
  }
  // Copies a shard with `to` in place of `from` and changed records, but with valid checksums.
  void forge(const std::string& source, const std::string& copy, const std::string& from,
             const std::string& to, const std::function<void(std::string&)>& change = {}) const {
    ShardReader reader(at(source));
    std::string info = reader.info();
    const size_t where = info.find(from);
    ASSERT_NE(where, std::string::npos) << from;
    info.replace(where, from.size(), to);
    AtomicFile file(at(copy));
    ShardWriter writer(file);
    for (size_t b = 0; b < reader.blocks().size(); ++b) {
      std::string bytes = reader.read(b);
      if (change) change(bytes);
      writer.record(reader.blocks()[b].name(), reader.blocks()[b].index, bytes);
    }
    writer.finish(info);
    file.commit();
  }
};

TEST_F(ShardRun, PlaceGivesTheSameBytesInAnyNumber) {
  expectTheSameInParts("vpl-place", scene_ + " -n 20k --seed 5", "placed.vpl", {1, 7, 64});
  expectTheSameInParts("vpl-place", scene_ + " -n 3k --depth 5", "deep.vpl", {3});
  expectTheSameInParts("vpl-place", scene_ + " -n 3k --method light", "light.vpl", {1, 7});
}

TEST_F(ShardRun, EstimateGivesTheSameBytesInAnyNumber) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl");
  expectTheSameInParts("vpl-estimate", estimate + " --photons 200k", "whole.vpl", {1, 7, 64});
  expectTheSameInParts("vpl-estimate", estimate + " --photons 20k --method even --emit-points 0",
                       "even.vpl", {3});
  expectTheSameInParts("vpl-estimate", estimate + " --method paths --points 8", "paths.vpl",
                       {1, 7});
  expectTheSameInParts("vpl-estimate", estimate + " --method both --photons 200k", "both.vpl", {3});
}

TEST_F(ShardRun, RenderGivesTheSameBytesInAnyNumber) {
  makeStages(scene_);
  const std::string render = scene_ + " --size 44x25 --layers all", vpls = " " + path("lit.vpl");
  expectTheSameInParts("vpl-render", render + vpls + " --spp 4", "whole.exr", {1, 7, 64});
  expectTheSameInParts("vpl-render", render + vpls + " --integrator guided --spp 2 --pixels half",
                       "guided.exr", {3});
  expectTheSameInParts("vpl-render", render + vpls + " --spp 2 --gather interleaved",
                       "interleaved.exr", {3});
  expectTheSameInParts("vpl-render", render + vpls + " --spp 2 --gather multidimensional",
                       "multidimensional.exr", {3});
  expectTheSameInParts("vpl-render", render + " --integrator path --spp 70", "path.exr", {1, 7});
  expectTheSameInParts("vpl-render", render + " --integrator light --spp 16", "light.exr",
                       {1, 7, 64});
  expectTheSameInParts("vpl-render", render + " --integrator light --spp 4 --filter mitchell",
                       "mitchell.exr", {7});
  expectTheSameInParts("vpl-render", render + " --integrator light --only direct", "direct.exr",
                       {2});
}

TEST_F(ShardRun, LightGroupsGiveTheSameBytesInAnyNumber) {
  std::ofstream(at("groups.toml")) << "[[mesh]]\nfile = " << scene_
                                   << "\n[[light]]\ntype = \"point\"\n"
                                      "position = [0.1, 0.3, 0.1]\npower = [1, 1, 1]\n"
                                      "group = \"fill\"\n";
  const std::string scene = path("groups.toml"),
                    render = scene + " --size 44x25 --layers light_groups";
  succeed("vpl-place", scene + " -n 4k --quiet -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 200 --quiet -o " + path("v.vpl"));
  expectTheSameInParts("vpl-estimate", scene + " " + path("v.vpl") + " --photons 50k", "g.vpl",
                       {3});
  for (const char* shard : {"1.shard", "2.shard", "3.shard"}) fs::remove(at(shard));
  expectTheSameInParts("vpl-render", render + " " + path("g.vpl") + " --spp 4", "vpl.exr", {3});
  expectTheSameInParts("vpl-render", render + " --integrator light --spp 4", "light.exr", {3});
}

TEST_F(ShardRun, PreviewsComeFromTheMerge) {
  const std::string render = scene_ + " --integrator path --size 32x24 --spp 2";
  succeed("vpl-render",
          render + " --exposure 2 --png " + path("whole.png") + " -o " + path("x.exr"));
  const std::string shards = makeShards("vpl-render", render, 2);
  succeed("vpl-merge",
          shards + "-o " + path("x.exr") + " --exposure 2 --png " + path("merged.png"));
  EXPECT_EQ(readAll(at("merged.png")), readAll(at("whole.png")));
  fail("vpl-merge", shards + "-o " + path("x.shard") + " --png " + path("x.png"), kExitUsage,
       {"--png"});
  fail("vpl-render", render + " --shard 1/2 --png " + path("x.png") + " -o " + path("x.shard"),
       kExitUsage, {"--png", "vpl-merge"});
}

TEST_F(ShardRun, PassesAreRefused) {
  const std::string render = scene_ + " --integrator path --shard 1/2 -o " + path("x.shard");
  // The shard's header is JSON, and merging loads the scene by the name in it.
  fail("vpl-render", path("a\xff.toml") + " --integrator path --shard 1/2 -o " + path("x.shard"),
       kExitUsage, {"a\\xff.toml' is no UTF-8", "rename it"});
  for (const char* budget : {" --time 2s", " --target-error 0.1", " --passes 4"})
    fail("vpl-render", render + budget, kExitUsage, {"--shard", "give --spp"});
}

TEST_F(ShardRun, LayersBelongToTheRun) {
  const std::string render = scene_ + " --integrator path --size 16x16 --spp 1";
  succeed("vpl-render", render + " --layers Z --shard 1/2 -o " + path("1.shard"));
  succeed("vpl-render", render + " --layers N --shard 2/2 -o " + path("2.shard"));
  fail("vpl-merge", path("1.shard") + " " + path("2.shard") + " -o " + path("x.exr"), kExitInput,
       {"2.shard: is of another run", "layers was \"Z\" and is now \"N\""});
}

TEST_F(ShardRun, InputsThatChangedSinceAreRefused) {
  makeStages(scene_);
  const std::string shards =
      makeShards("vpl-estimate", scene_ + " " + path("vpls.vpl") + " --photons 9k", 2);
  succeed("vpl-eliminate", path("candidates.vpl") + " -o " + path("vpls.vpl") + " -n 61 --quiet");
  fail("vpl-merge", shards + "-o " + path("x.vpl"), kExitInput, {"vpls.vpl: has changed since"});
}

TEST_F(ShardRun, ACheckpointIsOfOneShard) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " --photons 200k -o ";
  const std::string saved = " --checkpoint-every 0 --checkpoint " + path("work.checkpoint");
  succeed("vpl-estimate", estimate + path("1.shard") + " --shard 1/3 --quiet");
  succeed("vpl-estimate", estimate + path("saved.shard") + " --shard 1/3 --quiet" + saved);
  EXPECT_EQ(readAll(at("saved.shard")), readAll(at("1.shard")));
  const std::string endless = scene_ + " " + path("vpls.vpl") + " --photons 1G -o " +
                              path("x.shard") + " --checkpoint " + path("c");
  interrupt("vpl-estimate", endless + " --shard 1/3 --quiet", "c");
  fail("vpl-estimate", endless + " --shard 2/3", kExitInput,
       {"another run", "shard was \"1/3\" and is now \"2/3\""});
}

TEST_F(ShardRun, RangesAndMergesOfMergesGiveTheSameBytes) {
  const std::string place = scene_ + " -n 9k --quiet";
  succeed("vpl-place", place + " -o " + path("whole.vpl"));
  for (const char* part : {"1", "2-4", "5", "6-7"})
    succeed("vpl-place",
            place + " --shard " + part + "/7 -o " + path(part + std::string(".shard")));
  succeed("vpl-merge", path("6-7.shard") + " " + path("1.shard") + " -o " + path("ends.shard"));
  succeed("vpl-merge", path("5.shard") + " " + path("2-4.shard") + " -o " + path("middle.shard"));
  succeed("vpl-merge",
          path("middle.shard") + " " + path("ends.shard") + " -o " + path("all.shard"));
  for (const char* parts :
       {"all.shard", "ends.shard middle.shard", "5.shard 2-4.shard ends.shard"}) {
    std::string files, words = parts;
    std::replace(words.begin(), words.end(), ' ', '\n');
    std::istringstream lines(words);
    for (std::string name; std::getline(lines, name);) files += path(name) + " ";
    succeed("vpl-merge", files + "-o " + path("merged.vpl"));
    EXPECT_EQ(readAll(at("merged.vpl")), readAll(at("whole.vpl"))) << parts;
  }
}

// A name without an extension is that of the product, which replaces no shard.
TEST_F(ShardRun, AMergeWithoutAnExtensionReplacesNoShard) {
  makeShards("vpl-place", scene_ + " -n 2k", 2);
  fs::copy_file(at("1.shard"), at("other"));
  const std::string both = path("1.shard") + " " + path("2.shard");
  fail("vpl-merge", both + " -o " + path("other"), kExitOutput, {"name another file"});
  EXPECT_EQ(readAll(at("other")), readAll(at("1.shard")));
  for (int k = 0; k < 2; ++k) succeed("vpl-merge", both + " -o " + path("new"));
}

// The shards that the message names complete the set.
TEST_F(ShardRun, MissingShardsAreNamedWithTheCommandThatMakesThem) {
  const std::string place = scene_ + " -n 2k";
  succeed("vpl-place", place + " -o " + path("whole.vpl") + " --quiet");
  // The command leaves these options out: the others may be made on another machine.
  const std::string own = " --strict --no-clobber --progress text --checkpoint " + path("c") +
                          " --checkpoint-replace --checkpoint-every 9";
  makeShards("vpl-place", place + own, 6);
  const std::string three = path("1.shard") + " " + path("4.shard") + " " + path("5.shard");
  const std::string merge = three + " -o " + path("merged.vpl") + " --quiet";
  const Outcome r = tool("vpl-merge", merge);
  EXPECT_EQ(r.code, kExitInput);
  EXPECT_TRUE(contains(r.err, "of 6 shards these are missing: 2-3, 6")) << r.err;
  EXPECT_FALSE(fs::exists(at("merged.vpl")));
  const size_t command = r.err.find("vpl-place ");
  ASSERT_NE(command, std::string::npos) << r.err;
  const std::string made = r.err.substr(command, r.err.find('\n') - command);
  for (const char* option : {"--strict", "--no-clobber", "--progress", "--checkpoint"})
    EXPECT_FALSE(contains(made, option)) << made;
  ASSERT_EQ(shell("'" BNVPL_BIN "'/" + made).code, kExitOk) << made;
  succeed("vpl-merge", path("2-3-of-6.shard") + " " + path("6.shard") + " " + merge);
  EXPECT_EQ(readAll(at("merged.vpl")), readAll(at("whole.vpl")));
}

TEST_F(ShardRun, WhatDoesNotBelongTogetherIsRefusedByName) {
  const std::string place = scene_ + " -n 2k";
  makeShards("vpl-place", place, 3);
  succeed("vpl-place", place + " --shard 2-3/3 -o " + path("2-3.shard"));
  succeed("vpl-place", place + " --shard 2/4 -o " + path("four.shard"));
  succeed("vpl-place", scene_ + " -n 3k --shard 2/3 -o " + path("more.shard"));
  succeed("vpl-place", "'" BNVPL_SOURCE "/scenes/cornell/scene.toml' -n 2k --shard 2/3 -o " +
                           path("other.shard"));
  const auto refuse = [&](const std::string& names, const std::vector<std::string>& parts) {
    fail("vpl-merge", path("1.shard") + " " + names + " -o " + path("x.vpl"), kExitInput, parts);
  };
  refuse(path("2.shard") + " " + path("2-3.shard"),
         {"2.shard and ", "2-3.shard both hold shard 2"});
  refuse(path("1.shard"), {"both hold shard 1 of 3", "leave one of them out"});
  refuse(path("four.shard"), {"four.shard: is one of 4 shards"});
  refuse(path("more.shard"), {"more.shard: is of another run", "count was 2000 and is now 3000"});
  refuse(path("other.shard"), {"other.shard: is of another run", "inputs scene was"});
  refuse(path("missing.shard"), {"missing.shard: cannot be read"});
  succeed("vpl-place", place + " -o " + path("whole.vpl"));
  refuse(path("whole.vpl"), {"whole.vpl: is no shard"});
  EXPECT_FALSE(fs::exists(at("x.vpl")));
}

TEST_F(ShardRun, DamagedShardsAreRefusedByName) {
  const std::string shards = makeShards("vpl-place", scene_ + " -n 2k", 2);
  const std::string bytes = readAll(at("2.shard"));
  for (const size_t length :
       {size_t{0}, size_t{12}, size_t{30}, bytes.size() / 2, bytes.size() - 1}) {
    write("2.shard", bytes.substr(0, length));
    fail("vpl-merge", shards + "-o " + path("x.vpl"), kExitInput, {"2.shard: "});
  }
  for (size_t i = 0; i < 40; ++i) {
    std::string damaged = bytes;
    char& c = damaged[bytes.size() * i / 40];
    c = static_cast<char>(c ^ 4);
    write("2.shard", damaged);
    fail("vpl-merge", shards + "-o " + path("x.vpl"), kExitInput, {"2.shard: "});
  }
  write("2.shard", bytes + "x");
  fail("vpl-merge", shards + "-o " + path("x.vpl"), kExitInput, {"2.shard: "});
  EXPECT_FALSE(fs::exists(at("x.vpl")));
}

// These shards are whole and have valid checksums, but no stage would write them.
TEST_F(ShardRun, ForgedShardsAreRefused) {
  makeShards("vpl-place", scene_ + " -n 2k", 1);
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::function<void(std::string&)>& change = {}) {
    forge("1.shard", "forged.shard", from, to, change);
    fail("vpl-merge", path("forged.shard") + " -o " + path("x.vpl"), kExitInput, {"make", "again"});
  };
  const std::string deep(200, '[');
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"\"run\"", "\"ran\""},
           {"\"processor\":\"", "\"processor\":\"x"},
           {"\"processor\":", "\"place\":"},
           {"\"of\":1", "\"of\":0"},
           {"\"of\":1", "\"of\":-1"},
           {"[[1,1]]", "[]"},
           {"[[1,1]]", "[[1,18446744073709551615]]"},
           {"\"2k\"", "\"3k\""},
           {"\"2k\"", "\"-1\""},
           {"\"inputs\":{\"scene\":\"", "\"inputs\":{\"scene\":\"x"},
           {"\"command\":", "\"command\":" + deep},
           {"{", ""},
           {"{", "{},{"}}) {
    refused(from, to);
  }
  refused("", "", [](std::string& bytes) { bytes.resize(bytes.size() - 1); });
  refused("", "", [](std::string& bytes) { bytes.clear(); });
  const auto forged = [](bool share, size_t at, const std::string& with) {
    return [=](std::string& bytes) {
      if ((bytes.size() == sizeof(double)) == share) bytes.replace(at, with.size(), with);
    };
  };
  refused("", "", forged(false, 56, "\xff\xff\xff\xff"));  // NaN
  refused("", "", forged(true, 6, "\xff\xff"));            // a NaN as share of indirect light
  refused("", "", forged(false, 0, "\xff\xff\xff\xff\xff\xff\xff\x7f"));
  EXPECT_FALSE(fs::exists(at("x.vpl")));
}

// Such shards differ in bits from those of one processor.
TEST_F(ShardRun, ShardsOfAnotherProcessorAreRefusedByName) {
  makeShards("vpl-place", scene_ + " -n 2k", 2);
  forge("2.shard", "other.shard", "\"processor\":\"", "\"processor\":\"0");
  const std::string merge = " -o " + path("x.vpl");
  fail("vpl-merge", path("1.shard") + " " + path("other.shard") + merge, kExitInput,
       {"other.shard: was made on a processor that rounds otherwise than that of", "1.shard"});
  fail("vpl-merge", path("other.shard") + " " + path("1.shard") + merge, kExitInput,
       {"other.shard: was made on a processor that rounds otherwise than this one"});
  EXPECT_FALSE(fs::exists(at("x.vpl")));
  succeed("vpl-merge", path("1.shard") + " " + path("2.shard") + " --quiet" + merge);
}

TEST_F(ShardRun, InfoTellsWhatAShardHolds) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " --method both --photons 50k";
  makeShards("vpl-estimate", estimate, 3);
  succeed("vpl-merge",
          path("1.shard") + " " + path("3.shard") + " --quiet -o " + path("two.shard"));
  const Outcome text = tool("vpl-inspect", "info " + path("two.shard"));
  EXPECT_EQ(text.code, kExitOk) << text.err;
  for (const char* part : {"two.shard: part 1, 3 of 3 of vpl-estimate, ", "processor ", "build ",
                           "all checksums right", "photons", "command vpl-estimate "})
    EXPECT_TRUE(contains(text.out, part)) << part << text.out;
  const Outcome json = tool("vpl-inspect", "info --json " + path("two.shard"));
  EXPECT_TRUE(contains(json.out, "\"parts\": \"1, 3\"")) << json.out;
  std::string bytes = readAll(at("two.shard"));
  bytes[100] = static_cast<char>(bytes[100] ^ 4);
  write("two.shard", bytes);
  fail("vpl-inspect", "info " + path("two.shard"), kExitInput, {"two.shard: is damaged"});
  for (const char* command : {"check ", "compare "}) {
    fail("vpl-inspect", command + path("1.shard") + " " + path("1.shard"), kExitInput,
         {"1.shard: is a part of a result", "vpl-merge"});
  }
}

TEST_F(ShardRun, PartsAndNamesThatMeanNothingAreRefused) {
  const std::string place = scene_ + " -n 2k -o " + path("x.shard");
  for (const char* part : {"0/3", "4/3", "3-2/3", "1", "1/", "/3", "a/3", "1-/3", "1/0", "-1/3"})
    fail("vpl-place", place + " --shard=" + part, kExitUsage, {"--shard", "such as 3/64"});
  fail("vpl-place", scene_ + " -o " + path("x.vpl") + " --shard 1/2", kExitUsage, {"x.shard"});
  fail("vpl-place", place, kExitUsage, {"x.vpl"});
  makeShards("vpl-place", scene_ + " -n 2k", 1);
  fail("vpl-merge", path("1.shard") + " -o " + path("x.exr"), kExitUsage, {"x.vpl or x.shard"});
  fail("vpl-merge", path("1.shard") + " -o " + path("1.shard"), kExitUsage, {"same file"});
}

}  // namespace
}  // namespace bnvpl
